#pragma once

#include <string>
#include <vector>

#include "rift/control/waypoint.hpp"
#include "rift/experiment/track_options.hpp"
#include "rift/vision/calibration/calibration.hpp"
#include "rift/vision/tracking/track_run.hpp"
#include "track_request.hpp"

namespace rift::commands {

/// What the log was made from and how it went: camera, calibration, frame of the poses, options,
/// rows, rates, misses, latency.
std::string TrackJson(const TrackRequest& request, const vision::CameraModel& camera,
                      const experiment::TrackOptions& options, const vision::TrackRun& run,
                      int rows);
std::string TrackText(const vision::TrackRun& run, int rows);

/// The verdict of a calibration with its reasons, parameters and views.
std::string CalibrationText(const vision::Calibration& calibration);
/// The same in short, as comment lines for the head of the camera file.
std::string CalibrationComment(const vision::Calibration& calibration);

/// Waypoints made in the window as a waypoint file, which is an experiment as it is.
std::string WaypointsYaml(const std::vector<control::Waypoint>& waypoints);

}  // namespace rift::commands
