#pragma once

#include <opencv2/core.hpp>

#include "rift/view/track_scene.hpp"

namespace rift::view {

/// What the window shows.
struct TrackPicture {
  cv::Mat bgr;
  double px_per_shown = 1.0;  ///< pixels of the camera's picture for one of these
};

/// The camera's picture, at most 1280 px wide, with the tag's outline in green and its heading in
/// red, the trail in red, the path in black, waypoints in yellow, how far the trail lies off the
/// path in blue, where the robot has to stand in white, pose, rate and latency in words, and the
/// keys. Same scene, same pixels.
TrackPicture DrawTrack(const TrackScene& scene);

/// From points of a trail, some centimetres apart, to the nearest point of the path.
struct LateralLine {
  Eigen::Vector2d from_m, to_m;
};
std::vector<LateralLine> LateralLines(const std::vector<Eigen::Vector2d>& trail_m,
                                      const std::vector<Eigen::Vector2d>& path_m);

}  // namespace rift::view
