#pragma once

#include "rift/sessions/track/tracking.hpp"
#include "rift/vision/tracking/session.hpp"

namespace rift::sessions {

/// Sets the world frame that the job asks for and keeps it in the calibration's file. Throws
/// std::invalid_argument when it cannot be found, or when the file holds a better one.
void SetAndSaveWorld(const TrackingJob& job, const TrackingListener& listener,
                     vision::CameraSession& session);

}  // namespace rift::sessions
