#pragma once

#include <vector>

#include "rift/control/waypoint.hpp"
#include "rift/twin/options.hpp"
#include "rift/vision/camera/camera_model.hpp"

namespace rift::twin {

/// A 1080p camera that looks straight down on the middle of the waypoints, calibrated without
/// error. Its intrinsics are about those of the authors' webcam, whose own distortion (2.83 px RMS)
/// bends the picture's rim over. Throws std::invalid_argument when a waypoint lies outside the
/// picture and says how high the camera would have to hang.
vision::CameraModel OverheadCamera(const std::vector<control::Waypoint>& waypoints,
                                   const TwinOptions& options);

}  // namespace rift::twin
