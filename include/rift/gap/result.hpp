#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "rift/gap/comparison.hpp"
#include "rift/gap/likeness.hpp"
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

/// One simulated path held against repeats of the real one: what `rift gap` found.
struct GapResult {
  struct Trial {
    std::string path;  ///< of its log
    Comparison comparison;
  };

  GapOptions options;
  double tag_offset_m = 0.0;  ///< already in `reals`; for the record
  std::string sim_path;       ///< of its log
  trajectory::Trajectory sim;
  std::vector<Trial> trials;
  std::vector<trajectory::Trajectory> reals;  ///< one for each trial
  double mean_gap_m = kNotComputed;
  double noise_floor_m = kNotComputed;  ///< NaN for one real log
  RepeatVerdict verdict;
  std::optional<Likeness> likeness;  ///< only with repeats of the simulator
};

/// Fills in the mean, the noise floor and the verdict from the trials.
void Judge(GapResult& result);

}  // namespace rift::gap
