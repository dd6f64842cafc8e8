#pragma once

#include <filesystem>
#include <string>

#include "log.hpp"
#include "rift/experiment/experiment.hpp"
#include "rift/hardware/arming.hpp"
#include "rift/vision/camera/camera_model.hpp"

namespace rift::sessions {

/// Before the robot moves: the experiment and the camera (experiment.yaml, camera.yaml), so that a
/// folder that cannot be written is known in time.
void BeginDriveFolder(const std::filesystem::path& folder, const experiment::Experiment& experiment,
                      const vision::CameraModel& camera);

/// While the robot drives, the rest of the run folder: what a simulated run's has (trajectory.csv,
/// commands.csv, a summary.json that says interrupted), stages.csv and, in step with the camera,
/// encoders.csv in place of the true path.
DriveLog::Write WriterInto(const std::filesystem::path& folder,
                           const experiment::Experiment& experiment);

/// Ends the log of a drive, and replaces its summary.json when the log is whole. Returns why it is
/// not; empty when it is.
std::string CloseDrive(const std::filesystem::path& folder,
                       const experiment::Experiment& experiment, const hardware::DriveRun& run,
                       DriveLog& log);

}  // namespace rift::sessions
