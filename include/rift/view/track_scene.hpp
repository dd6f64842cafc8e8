#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "rift/vision/camera/camera_model.hpp"
#include "rift/vision/camera/camera_state.hpp"
#include "rift/vision/camera/frame.hpp"
#include "rift/vision/tracking/tag_tracker.hpp"

namespace rift::view {

/// A waypoint as the view draws it, in the map.
struct MapPlace {
  std::string name;
  Eigen::Vector2d p_in_map;
};

/// One moment of a tracking session, to be drawn over the camera's picture.
struct TrackScene {
  const vision::CameraModel* camera = nullptr;
  const vision::Frame* frame = nullptr;  ///< the picture; none: nothing came yet
  std::optional<vision::Sighting> sighting;
  std::vector<Eigen::Vector2d> trail_m;  ///< where the tag was, in the map
  std::vector<Eigen::Vector2d> path_m;   ///< to hold the trail against; may be empty
  std::vector<MapPlace> waypoints;
  double plane_z_m = 0.0;  ///< of the map: path, waypoints and trail lie in it
  vision::CaptureStatus status;
  double latency_s = 0.0;            ///< from the light to the pose; NaN of a recording
  std::vector<std::string> prompts;  ///< what the user is asked or told, lines at the foot
};

}  // namespace rift::view
