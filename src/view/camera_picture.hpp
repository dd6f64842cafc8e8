#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "rift/vision/camera/frame.hpp"

namespace rift::view {

/// The camera's picture in blue, green and red, at most 1280 px wide; a dark one of that size where
/// there is no frame.
cv::Mat ShownPicture(const vision::Frame* frame, int width_px, int height_px);

/// Light letters on a darkened strip, from the top or the bottom of the picture, wrapped so that
/// `right_px` are left free at the right.
void DrawLines(cv::Mat& picture, const std::vector<std::string>& lines, bool at_top,
               int right_px = 0);

}  // namespace rift::view
