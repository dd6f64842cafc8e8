#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "rift/sweep/explain/effects.hpp"
#include "rift/sweep/falsify/result.hpp"

namespace rift::sweep {

/// A patch of the plane of two parameters, and how often trials fail there.
struct RegionCell {
  std::string x, y;                  ///< the value, or the range
  double x_low = 0.0, x_high = 1.0;  ///< place on the axis; the level's number for a list
  double y_low = 0.0, y_high = 1.0;
  double share = gap::kNotComputed;  ///< of failing trials; in a range the nearest settings' mean
  int trials = 0;                    ///< counted for it
};

/// More of them nobody reads, and two lists of thousands of values each would fill the memory.
constexpr std::size_t kMostRegionCells = 1600;

struct FailingRegion {
  int x_parameter = -1;  ///< -1: there are no two parameters to show
  int y_parameter = -1;
  std::vector<RegionCell> cells;
  bool is_smoothed = false;  ///< shares are of the nearest settings, wherever they are
  int nearest = 0;           ///< so many, where they are smoothed
};

/// The two parameters that matter most, by their shares.
std::array<int, 2> MostInfluential(const SweepResult& result, const Effects& effects);

/// The failing region over two parameters, all others being what the trials had. Lists of values
/// give a cell for each pair; a range is cut into patches (even in the logarithm, where it is) that
/// count the settings nearest to them: 12, or of fewer than 36 (on each value of a list) a third,
/// of a list only those of the patch's own value, and all that are as near as the last of them. Of
/// more than 4000 trials a sample is looked at. No cells where there would be more than
/// kMostRegionCells.
FailingRegion MapFailures(const SweepResult& result, std::array<int, 2> parameters);

}  // namespace rift::sweep
