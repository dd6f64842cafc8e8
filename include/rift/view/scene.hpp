#pragma once

#include <Eigen/Core>
#include <limits>
#include <string>
#include <vector>

#include "rift/geometry/floor.hpp"
#include "rift/geometry/pose2.hpp"
#include "rift/trial/robot.hpp"

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
struct Stage {
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
  size_t trail_points = 0;  ///< of Stage::trail_m that had been measured by now
  std::string outcome;      ///< how the run ended; empty while it goes on
};

/// A run as pictures: one scene each 1/fps.
struct Film {
  Stage stage;
  std::vector<Scene> scenes;
  double fps = 0.0;
};

}  // namespace rift::view
