#pragma once

#include <memory>
#include <string>

#include "rift/experiment/experiment.hpp"
#include "rift/hardware/camera_poses.hpp"
#include "rift/vision/camera/capture_thread.hpp"

namespace rift::commands {

/// The calibration of the camera above the floor. Throws std::invalid_argument, saying what to do,
/// when it has no world frame: the waypoints would mean nothing.
vision::CameraModel ReadDriveCamera(const std::string& calibration);

/// A live camera that was seen to fit its calibration.
struct DriveCamera {
  std::unique_ptr<vision::Capture> capture;
  vision::CameraModel model;         ///< with the size of the pictures
  std::optional<double> moved_by_m;  ///< since the world frame was set; none: no reference tag
  int robots_tags = 0;               ///< with the robot's id, in the first picture
};

/// Opens the camera and looks at its first picture. Throws std::invalid_argument for a recording
/// and for pictures of another size than the calibration's; std::runtime_error when no picture
/// comes, or two tags have the robot's id.
DriveCamera OpenDriveCamera(const std::string& camera, vision::CameraModel model,
                            const experiment::Experiment& experiment);

/// What the operator should know before the start, one line each.
std::vector<std::string> WarningsOf(const DriveCamera& camera);

}  // namespace rift::commands
