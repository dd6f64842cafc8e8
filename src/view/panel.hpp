#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "layout.hpp"

namespace rift::view {

/// The column of text: title, time, pose, speed, powers, waypoint, outcome, and `footer` below.
void DrawPanel(cv::Mat& picture, const Stage& stage, const Layout& layout, const Scene& scene,
               const std::vector<std::string>& footer);

}  // namespace rift::view
