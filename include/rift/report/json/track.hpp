#pragma once

#include <string>
#include <vector>

#include "rift/control/waypoint.hpp"
#include "rift/experiment/track_options.hpp"
#include "rift/vision/calibration/calibration.hpp"
#include "rift/vision/tracking/session_options.hpp"
#include "rift/vision/tracking/track_run.hpp"

namespace rift::report {

/// What a tracking run was asked for, as far as its record says so.
struct TrackInputs {
  std::string camera;            ///< device, stream or pattern of pictures
  std::string calibration;       ///< file
  std::string calibration_hash;  ///< of its bytes
  vision::SessionOptions session;
};

/// What the log was made from and how it went: camera, calibration, frame of the poses, options,
/// rows, rates, misses, latency.
std::string TrackJson(const TrackInputs& inputs, const vision::CameraModel& camera,
                      const experiment::TrackOptions& options, const vision::TrackRun& run,
                      int rows);
std::string TrackText(const vision::TrackRun& run, int rows);

/// The verdict of a calibration with its reasons, parameters and views.
std::string CalibrationText(const vision::Calibration& calibration);
/// The same in short, as comment lines for the head of the camera file.
std::string CalibrationComment(const vision::Calibration& calibration);

/// Waypoints made in the window as a waypoint file, which is an experiment as it is.
std::string WaypointsYaml(const std::vector<control::Waypoint>& waypoints);

}  // namespace rift::report
