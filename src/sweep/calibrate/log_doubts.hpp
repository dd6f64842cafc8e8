#pragma once

#include <limits>
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
  std::string group;                                            ///< logs of one are compared
  double way_ratio = std::numeric_limits<double>::quiet_NaN();  ///< WayRatio; NaN: not known
};

/// What makes logs doubtful for a fit though each looks sound, a line each that names its log: one
/// that does not come near to a waypoint, which its controller must have passed within the reach
/// radius, one that is a copy of another, and one that was faster or slower than the commands of
/// its setting make the others of its group; said of the first, with how many more there are.
std::vector<std::string> DoubtsOfLogs(const std::vector<LogOfTask>& logs);

}  // namespace rift::sweep
