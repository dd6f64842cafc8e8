#pragma once

#include <opencv2/core.hpp>

#include "rift/vision/calibration/live_views.hpp"

namespace rift::view {

/// The camera's picture, at most 1280 px wide, with the corners of the board that were found last
/// in green, those of the views that were taken as blue dots, the outline of where the board is
/// wanted next in yellow, the coverage as bars with a line where it is enough, and in words what to
/// do. Same scene, same pixels.
cv::Mat DrawCalibrating(const vision::LiveScene& scene);

}  // namespace rift::view
