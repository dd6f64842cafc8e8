#pragma once

#include <string>

#include "rift/experiment/track_options.hpp"
#include "rift/vision/calibration/calibration.hpp"
#include "track_request.hpp"
#include "track_run.hpp"

namespace rift::commands {

/// What the log was made from and how it went: camera, calibration, frame of the poses, options,
/// rows, rates, misses, latency.
std::string TrackJson(const TrackRequest& request, const vision::CameraModel& camera,
                      const experiment::TrackOptions& options, const TrackRun& run, int rows);
std::string TrackText(const TrackRun& run, int rows);

/// The verdict of a calibration with its reasons, parameters and views.
std::string CalibrationText(const vision::Calibration& calibration);
/// The same in short, as comment lines for the head of the camera file.
std::string CalibrationComment(const vision::Calibration& calibration);

}  // namespace rift::commands
