#include "rift/control/waypoint.hpp"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "rift/geometry/pose2.hpp"

namespace rift::control {
namespace {

constexpr double kFarthest_m = 1e3;

}  // namespace

void CheckWaypoints(const std::vector<Waypoint>& waypoints) {
  if (waypoints.size() < 2) {
    throw std::invalid_argument(fmt::format(
        "{} waypoint(s) given: a start and at least one more are needed", waypoints.size()));
  }
  for (size_t i = 0; i < waypoints.size(); ++i) {
    const Waypoint& waypoint = waypoints[i];
    const double heading_deg = waypoint.heading_deg.value_or(0.0);
    if (waypoint.Position().allFinite() &&
        waypoint.Position().cwiseAbs().maxCoeff() <= kFarthest_m && std::isfinite(heading_deg)) {
      continue;
    }
    throw std::invalid_argument(
        fmt::format("waypoint {} '{}' at x {}, y {}, heading {} must be finite and within {} m",
                    i + 1, waypoint.name, waypoint.x_m, waypoint.y_m, heading_deg, kFarthest_m));
  }
}

geometry::Pose2 StartPose(const std::vector<Waypoint>& waypoints) {
  CheckWaypoints(waypoints);
  const Waypoint& start = waypoints.front();
  if (start.heading_deg) {
    return {start.x_m, start.y_m, geometry::WrapToPi(geometry::RadFromDeg(*start.heading_deg))};
  }
  const Eigen::Vector2d ahead = waypoints[1].Position() - start.Position();
  return {start.x_m, start.y_m, std::atan2(ahead.y(), ahead.x())};
}

}  // namespace rift::control
