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
#include "rift/statistics/sequential.hpp"
#include "rift/trajectory/trajectory.hpp"

namespace rift::gap {

enum class Verdict {
  kNotSeenToFail,  ///< no repeat failed, and they are too few to show more
  kPassed,         ///< the share of runs that fail is shown to be below VerdictOptions::share
  kFalsified,      ///< it is shown to be above
  kUndecided,      ///< some repeats failed, or there are none
};

constexpr std::array<std::string_view, 4> EnumNames(Verdict) {
  return {"not seen to fail", "passed", "falsified", "undecided"};
}

/// What repeats of one setting say together about the share of all its runs that would fail.
struct RepeatVerdict {
  Verdict verdict = Verdict::kUndecided;
  int above = 0;  ///< repeats that fail: the gap exceeds the threshold, or the robot did not arrive
  int repeats = 0;  ///< that tell
  /// The share is above `share_low` with `confidence` at every look, below `share_high` likewise.
  double share_low = 0.0;
  double share_high = 1.0;
  double confidence = 0.95;
  statistics::ShareEvidence evidence;  ///< about VerdictOptions::share
  int settings = 1;                    ///< judged together

  /// Falsified, or undecided with a failure, which may be one of many.
  bool MayFail() const {
    return verdict == Verdict::kFalsified || (verdict == Verdict::kUndecided && above > 0);
  }
};

/// By the counts alone: the setting is the only one that is judged.
RepeatVerdict JudgeCounts(int above, int repeats, const VerdictOptions& options);

/// NaN does not tell.
RepeatVerdict JudgeRepeats(std::span<const double> gaps_m, double threshold_m,
                           const VerdictOptions& options = {});

/// Judges `settings` settings at once, of which the verdicts (as JudgeCounts gives them) are those
/// that were tried: of the falsified and of the passed ones at most a share of 1 - confidence is
/// wrong on average (statistics::NeededEvidence), so that a setting among many needs more repeats.
void JudgeTogether(std::span<RepeatVerdict> verdicts, int settings, const VerdictOptions& options);

/// "falsified", "passed", "not seen to fail (3 trials)", "undecided (2 of 5 trials fail)".
std::string VerdictText(const RepeatVerdict& verdict);

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
  VerdictOptions judged_by;
  RepeatVerdict verdict;
  std::optional<Likeness> likeness;  ///< only with repeats of the simulator
};

/// For each of the real trajectories the first before it with the same positions, if there is one,
/// to 10 um, as of a log that was written anew: a log that was copied is no repeat of its own.
std::vector<std::optional<size_t>> CopiesAmong(std::span<const trajectory::Trajectory> reals);

/// Those of the real trajectories that are no copies.
std::vector<trajectory::Trajectory> Distinct(std::span<const trajectory::Trajectory> reals);

/// Fills in the mean from the trials, and the noise floor and the verdict from those of them that
/// are no copies.
void Judge(GapResult& result);

}  // namespace rift::gap
