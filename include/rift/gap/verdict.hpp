#pragma once

#include <array>
#include <span>
#include <string_view>
#include <vector>

#include "rift/gap/options.hpp"
#include "rift/trajectory/trajectory.hpp"

namespace rift::gap {

enum class Verdict { kNotFalsified, kFalsified, kUndecided };

constexpr std::array<std::string_view, 3> EnumNames(Verdict) {
  return {"not falsified", "falsified", "undecided"};
}

/// What repeats of one setting say together.
struct RepeatVerdict {
  Verdict verdict = Verdict::kUndecided;  ///< falsified or not only when every repeat agrees
  int above = 0;                          ///< repeats whose gap exceeds the threshold
  int repeats = 0;
  /// Clopper-Pearson interval for the share of all such trials that would exceed the threshold.
  double share_low = 0.0;
  double share_high = 1.0;
  double confidence = 0.95;
};

/// Repeats that disagree are undecided; so is a setting without a single gap.
RepeatVerdict JudgeRepeats(std::span<const double> gaps_m, double threshold_m,
                           double confidence = 0.95);

/// Mean gap between every two of the real trajectories: no simulator can be expected to be closer
/// to them than they are to each other. NaN for fewer than two.
double NoiseFloor_m(std::span<const trajectory::Trajectory> reals, const GapOptions& options);

}  // namespace rift::gap
