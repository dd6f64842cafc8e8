#pragma once

#include <opencv2/core.hpp>

#include "rift/vision/camera/frame.hpp"

namespace rift::vision {

/// The whole picture in blue, green, red; empty when it cannot be decoded.
cv::Mat BgrOf(const Frame& frame);

/// A small grey version of it, where that is cheaper; empty when it cannot be decoded.
cv::Mat GlanceAt(const Frame& frame);

}  // namespace rift::vision
