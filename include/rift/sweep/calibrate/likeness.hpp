#pragma once

#include <string>
#include <vector>

#include "rift/gap/likeness.hpp"
#include "rift/sweep/calibrate/distinction.hpp"
#include "rift/sweep/calibrate/prediction.hpp"
#include "rift/sweep/calibrate/repeated_trial.hpp"
#include "rift/sweep/falsify/evaluator.hpp"
#include "rift/sweep/falsify/simulated_trial.hpp"
#include "rift/trial/loop_delay.hpp"

namespace rift::sweep {

/// Likeness of paths, and of what only the controller's side can tell.
struct DriveLikeness {
  gap::Likeness path;
  gap::BothSides loop_delay_s;         ///< median over the paths
  gap::BothSides loop_r2;              ///< share of the yaw rate that the steering explains there
  gap::BothSides steering_gain_rad_s;  ///< yaw rate for each unit of power_right - power_left
  int runs = 0;                        ///< simulated, those that failed among them
  int circled_runs = 0;  ///< of the failed ones those that passed a waypoint and circled
  PathPrediction prediction;
  RankAgreement ranks;
  Distinction told_apart;
  int failed_runs = 0;
};

/// The runs of each trial are matched to it (gap::RepeatedSetting) when `is_matched`: each set out
/// from where the real one stood. Paths too short for a loop delay have none.
DriveLikeness MeasureDriveLikeness(const std::vector<RepeatedTrial>& trials, bool is_matched,
                                   const gap::GapOptions& gap, const gap::LikenessOptions& options,
                                   std::mt19937_64& generator);

/// Likeness of the trials that share a value of the main factor.
struct GroupLikeness {
  std::string level;  ///< "all" for every trial
  DriveLikeness likeness;
};

/// Likeness of a grid sweep's candidates to its repeated reference logs, by the values of its main
/// factor and over all ("all", last). Empty where the sweep has no repeated logs to be like.
/// Simulated candidates drive likeness.runs times, `threads` of them at once, which changes no
/// result.
std::vector<GroupLikeness> MeasureSweepLikeness(Evaluator& evaluator, int threads = 1);

}  // namespace rift::sweep
