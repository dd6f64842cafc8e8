#pragma once

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "rift/gap/likeness.hpp"
#include "rift/sweep/falsify/evaluator.hpp"
#include "rift/sweep/falsify/simulated_trial.hpp"
#include "rift/trial/loop_delay.hpp"

namespace rift::sweep {

/// A real trial and what the simulator made of it. Trials of one setting repeat each other.
struct RepeatedTrial {
  std::string setting;  ///< the same for all repeats
  trajectory::Trajectory real;
  std::vector<trajectory::Trajectory> runs;  ///< those that reached the end
  std::vector<control::Waypoint> waypoints;
  control::NavigatorOptions control;
  int failed_runs = 0;  ///< those that did not, or only on a detour
};

/// Length of a path in strides of 20 mm, so that jitter adds little.
double LengthByStrides_m(const trajectory::Trajectory& path);

/// Of things with a setting and a path: the longest path of each setting, by strides.
template <class T>
std::map<std::string, double> LongestBySetting_m(const std::vector<T>& things,
                                                 trajectory::Trajectory T::*path) {
  std::map<std::string, double> longest_m;
  for (const T& thing : things) {
    double& longest = longest_m[thing.setting];
    longest = std::max(longest, LengthByStrides_m(thing.*path));
  }
  return longest_m;
}

/// Runs longer than `longest_run` times the longest real path of their setting passed a waypoint
/// and circled: they move to the failed ones.
std::vector<RepeatedTrial> WithoutDetours(std::vector<RepeatedTrial> trials, double longest_run);

/// Likeness of paths, and of what only the controller's side can tell.
struct DriveLikeness {
  gap::Likeness path;
  gap::BothSides loop_delay_s;         ///< median over the paths
  gap::BothSides loop_r2;              ///< share of the yaw rate that the steering explains there
  gap::BothSides steering_gain_rad_s;  ///< yaw rate for each unit of power_right - power_left
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
std::vector<GroupLikeness> MeasureSweepLikeness(Evaluator& evaluator);

}  // namespace rift::sweep
