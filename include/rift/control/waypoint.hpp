#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "rift/geometry/pose2.hpp"

namespace rift::control {

/// A place to drive to, in the world frame. The first one of a list is where the robot is put
/// down; its heading is the only one that means something. The keys are those of the waypoint
/// files that users already have.
struct Waypoint {
  std::string name;
  double x_m = 0.0;
  double y_m = 0.0;
  std::optional<double> heading_deg;
  bool stop = true;

  Eigen::Vector2d Position() const { return {x_m, y_m}; }

  /// A real robot must not drive to a place that was forgotten.
  static constexpr std::array<std::string_view, 2> kRequired{"x", "y"};

  /// Calls field(key, member, [min, max,] help) for every member; min and max are inclusive.
  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    field("name", self.name, "what the waypoint is called in tables and figures");
    field("x", self.x_m, -1e3, 1e3, "position in metres, x right");
    field("y", self.y_m, -1e3, 1e3, "position in metres, y up");
    field("heading", self.heading_deg, -360.0, 360.0,
          "start heading in degrees, counter-clockwise from +x; first waypoint only");
    field("stop", self.stop, "stop here, or pass through at cruise speed");
  }
};

/// Throws std::invalid_argument unless there is a start and at least one waypoint to drive to,
/// all of them finite.
void CheckWaypoints(const std::vector<Waypoint>& waypoints);

/// world_from_robot at the start: at the first waypoint, with its heading or, when it has none,
/// towards the second. Throws like CheckWaypoints.
geometry::Pose2 StartPose(const std::vector<Waypoint>& waypoints);

}  // namespace rift::control
