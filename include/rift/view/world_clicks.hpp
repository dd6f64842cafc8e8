#pragma once

#include <vector>

#include "rift/vision/tracking/world_setting.hpp"

namespace rift::view {

/// The world frame from points that the user clicks in a window, in their order. Throws
/// std::invalid_argument when they make no frame, or the pictures are of another size than the
/// calibration; std::runtime_error when there is no window, the camera fails or the user ends it.
vision::WorldFrame WorldFromClicks(const vision::WorldSetting& setting,
                                   const std::vector<vision::FloorMark>& points);

}  // namespace rift::view
