#pragma once

#include <opencv2/core.hpp>

#include "painter.hpp"

namespace rift::view {

/// Everything in a run's pictures that does not move: paper, shaded ground, patches, reference
/// path, waypoints, scale bar, captions.
cv::Mat Backdrop(const StaticScene& fixed, const Layout& layout);

/// The silhouette of the ground from the side between two y.
void DrawProfile(cv::Mat& picture, const StaticScene& fixed, const Layout& layout, double y_low_m,
                 double y_high_m);

}  // namespace rift::view
