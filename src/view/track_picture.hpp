#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "rift/view/track_scene.hpp"

namespace rift::view {

/// What the window shows.
struct TrackPicture {
  cv::Mat bgr;
  double px_per_shown = 1.0;  ///< pixels of the camera's picture for one of these
};

/// The camera's picture, at most 1280 px wide, with each robot's tag outlined in green, its heading
/// and trail in red, the path in black, waypoints in yellow, how far the first robot's trail lies
/// off the path in blue and in mm, where the robot has to stand in white, poses, rate and latency
/// in words, and the keys. Several robots have their ids beside them. Same scene, same pixels.
TrackPicture DrawTrack(const TrackScene& scene);

/// The lines at its top: poses, how far the first robot is off its path, state of the camera.
std::vector<std::string> WordsOf(const TrackScene& scene);

}  // namespace rift::view
