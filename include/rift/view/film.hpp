#pragma once

#include <Eigen/Core>

#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "rift/control/controller.hpp"
#include "rift/geometry/floor.hpp"
#include "rift/geometry/pose2.hpp"
#include "rift/simulation/options.hpp"
#include "rift/trajectory/trajectory.hpp"
#include "rift/trial/robot.hpp"
#include "rift/view/options.hpp"

namespace rift::view {

/// Outline of the robot; the origin is the middle of the axle (facts: the authors' world).
struct BodyShape {
  double chassis_radius_m = 0.0484;
  double chassis_height_m = 0.0266;
  double chassis_bottom_m = -0.011;  ///< above the axle
  double wheel_radius_m = 0.016;
  double wheel_width_m = 0.0068;
  double track_m = 0.083;
};

/// The robot's outline as its simulation has it.
BodyShape ShapeOf(const simulation::BodyOptions& body);

/// Heights in m on a grid: height_m[row * columns + column], row 0 at y_min_m; -infinity where
/// there is no ground.
struct Ground {
  double x_min_m = 0.0;
  double y_min_m = 0.0;
  double cell_m = 0.0;
  int columns = 0;
  int rows = 0;
  std::vector<float> height_m;

  float At(int column, int row) const {
    return height_m[static_cast<size_t>(row) * columns + column];
  }
};

/// What stays the same during a run.
struct StaticScene {
  std::string title;
  Ground ground;
  double top_m = 0.0;  ///< above the highest point of robot and ground
  std::vector<geometry::NamedPoint> waypoints;
  std::vector<Eigen::Vector2d> reference_m;
  std::vector<geometry::FloorArea> patches;
  BodyShape body;
  std::vector<Eigen::Vector2d> trail_m;  ///< every position that was measured, in order
};

/// One moment of a run. NaN: not known.
struct Scene {
  static constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

  double t_s = 0.0;  ///< since the start of the run
  geometry::Pose2 world_from_robot;
  double z_m = 0.0;        ///< of the middle of the axle
  double roll_rad = 0.0;   ///< right side down positive
  double pitch_rad = 0.0;  ///< nose down positive
  double speed_mps = kUnknown;
  control::WheelPower power{kUnknown, kUnknown};
  int target = -1;          ///< index of the waypoint driven to; -1: none
  size_t trail_points = 0;  ///< of StaticScene::trail_m that had been measured by now
  std::string outcome;      ///< how the run ended; empty while it goes on
};

/// A run as pictures: one scene each 1/fps.
struct Film {
  StaticScene fixed;
  std::vector<Scene> scenes;
  double fps = 0.0;
};

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

/// The task in the picture: its waypoints, and the path to keep.
void ShowTask(Run& shown, const control::Task& task);

/// Pictures at start, start + 1/fps, ...: as many as duration times fps (rounded, at least one),
/// the last of them at the end of the run.
/// Throws std::invalid_argument when truth has no pose or one that is not finite, or when the film
/// would be longer than 100'000 pictures.
Film MakeFilm(const Run& run, const ViewOptions& options = {});

/// The run `t_s` seconds after its start, between two poses by linear interpolation.
Scene SceneAt(const Run& run, double t_s);

/// Where a window is in its film.
struct Playback {
  double t_s = 0.0;  ///< of the film
  double speed = 1.0;
  bool paused = false;
  bool left = false;          ///< the user is done
  double over_since_s = 0.0;  ///< at the window, how long the end has been shown
};

/// After a key as cv::waitKeyEx reports it; -1 is no key.
Playback AfterKey(Playback playback, int key);
/// After `dt_s` seconds at the window.
Playback AfterTime(Playback playback, double dt_s, double duration_s);

}  // namespace rift::view
