#pragma once

#include <future>

#include "drive_operator.hpp"
#include "drive_run.hpp"
#include "rift/hardware/camera_poses.hpp"
#include "rift/view/track_window.hpp"

namespace rift::commands {

/// The camera's picture with tag, trail and waypoints in a window, until `drive` is over; closing
/// it stops the robot.
void ShowUntilOver(const std::future<DriveRun>& drive, view::TrackWindow& window,
                   const hardware::CameraPoses& poses, const vision::CameraModel& camera,
                   const experiment::Experiment& experiment, DriveOperator& person);

}  // namespace rift::commands
