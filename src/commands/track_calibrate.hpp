#pragma once

#include <functional>
#include <string>

#include "rift/experiment/track_options.hpp"
#include "rift/vision/calibration/calibration.hpp"
#include "track_request.hpp"

namespace rift::commands {

/// Calibrates from pictures of the board, or from a camera before which it is moved about: views
/// unlike those there are already are taken until they cover everything, the user ends it, or the
/// recording does. Throws std::invalid_argument for no pictures, std::runtime_error when the camera
/// fails before there was anything to calibrate from.
vision::Calibration CalibrateFor(const TrackRequest& request,
                                 const experiment::TrackOptions& options,
                                 const std::function<bool()>& is_stopped,
                                 const std::function<void(const std::string&)>& say);

}  // namespace rift::commands
