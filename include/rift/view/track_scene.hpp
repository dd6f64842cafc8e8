#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "rift/geometry/floor.hpp"
#include "rift/geometry/pose2.hpp"
#include "rift/vision/camera/camera_model.hpp"
#include "rift/vision/camera/camera_source.hpp"
#include "rift/vision/camera/frame.hpp"
#include "rift/vision/tracking/tag_tracker.hpp"

namespace rift::view {

/// From a point of a trail to the nearest point of a path.
struct LateralLine {
  Eigen::Vector2d from_m, to_m;
};

/// How a trail lies beside a path.
struct BesidePath {
  std::vector<LateralLine> lines;  ///< from points of the trail some centimetres apart
  double largest_m = 0.0;          ///< distance of any of its points, of those left out as well
};

/// A robot that is looked for.
struct SceneRobot {
  int tag_id = 0;
  std::optional<vision::Sighting> sighting;  ///< in this picture
  std::vector<Eigen::Vector2d> trail_m;      ///< where its tag was, in the map
  BesidePath beside;                         ///< its trail beside the path of the scene
};

/// One moment of a tracking session, to be drawn over the camera's picture.
struct TrackScene {
  const vision::CameraModel* camera = nullptr;
  const vision::Frame* frame = nullptr;  ///< the picture; none: nothing came yet
  std::vector<SceneRobot> robots;
  std::vector<Eigen::Vector2d> path_m;          ///< of the first robot; may be empty
  std::vector<geometry::NamedPoint> waypoints;  ///< in the map
  std::optional<geometry::Pose2> stand_at;      ///< where the robot has to be put; none: anywhere
  double plane_z_m = 0.0;                       ///< of the map: path, waypoints and trail lie in it
  vision::CaptureStatus status;
  double latency_s = 0.0;            ///< from the light to the pose; NaN of a recording
  std::vector<std::string> prompts;  ///< what the user is asked or told, lines at the foot
  /// What keys and clicks do, a line below the prompts; empty: none.
  std::string keys =
      "click: waypoint   w: waypoint here   s: stop or pass   u: undo   c: clear trail   q: quit";
};

}  // namespace rift::view
