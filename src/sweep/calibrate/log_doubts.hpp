#pragma once

#include <string>
#include <vector>

#include "rift/control/waypoint.hpp"
#include "rift/trajectory/trajectory.hpp"

namespace rift::sweep {

/// A log of a fit and the task that the simulator drives for it.
struct LogOfTask {
  std::string source;
  const trajectory::Trajectory* log;         ///< outlives this
  std::vector<control::Waypoint> waypoints;  ///< none: the task has none
  double reach_radius_m = 0.0;
};

/// What makes logs doubtful for a fit though each looks sound, a line each that names its log: one
/// that does not come near to a waypoint, which its controller must have passed within the reach
/// radius, and one that is a copy of another; said of the first, with how many more there are.
std::vector<std::string> DoubtsOfLogs(const std::vector<LogOfTask>& logs);

}  // namespace rift::sweep
