#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

#include "rift/geometry/floor.hpp"
#include "rift/trajectory/trajectory.hpp"
#include "rift/view/options.hpp"
#include "rift/view/scene.hpp"

namespace rift::view {

/// A finished run as its maker knows it.
struct Run {
  std::string title;
  std::vector<geometry::NamedPoint> waypoints;  ///< the start first
  std::vector<Eigen::Vector2d> reference_m;     ///< path to compare with; may be empty
  std::vector<geometry::FloorArea> patches;
  BodyShape body;
  /// Height of the ground in m at x, y; -infinity where there is none. Unset: a floor at 0.
  std::function<double(double x_m, double y_m)> height_at;
  /// Where the robot really was: the middle of its axle, at least one pose, yaw known. An unknown
  /// z, roll or pitch counts as standing level on the ground.
  trajectory::Trajectory truth;
  /// What was measured and decided, on the same clock; may be empty. Its targets tell the active
  /// waypoint, its channels power_left and power_right the powers (those of `truth` come first).
  trajectory::Trajectory logged;
  std::string outcome;  ///< "reached"
};

/// Pictures at start, start + 1/fps, ...: as many as duration times fps (rounded, at least one),
/// the last of them at the end of the run.
/// Throws std::invalid_argument when truth has no pose or one that is not finite, or when the film
/// would be longer than 100'000 pictures.
Film MakeFilm(const Run& run, const ViewOptions& options = {});

/// The run `t_s` seconds after its start, between two poses by linear interpolation.
Scene SceneAt(const Run& run, double t_s);

}  // namespace rift::view
