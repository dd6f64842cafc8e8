#pragma once

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "rift/control/options.hpp"
#include "rift/control/waypoint.hpp"
#include "rift/trajectory/trajectory.hpp"

namespace rift::sweep {

/// A real trial and what the simulator made of it. Trials of one setting repeat each other.
struct RepeatedTrial {
  std::string setting;  ///< the same for all repeats
  trajectory::Trajectory real;
  std::vector<trajectory::Trajectory> runs;  ///< those that reached the end
  std::vector<control::Waypoint> waypoints;
  control::NavigatorOptions control;
  int failed_runs = 0;   ///< those that did not, or only on a detour
  int circled_runs = 0;  ///< those on a detour: they passed a waypoint and circled
  /// Further real trials of the setting that are not judged themselves.
  std::vector<trajectory::Trajectory> other_reals;
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

}  // namespace rift::sweep
