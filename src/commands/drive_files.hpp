#pragma once

#include <filesystem>

#include "drive_run.hpp"
#include "rift/vision/camera/camera_model.hpp"

namespace rift::commands {

/// Before the robot moves: the experiment and the camera (experiment.yaml, camera.yaml), so that a
/// folder that cannot be written is known in time.
void BeginDriveFolder(const std::filesystem::path& folder, const experiment::Experiment& experiment,
                      const vision::CameraModel& camera);

/// The rest of the run folder: what a simulated run's has (trajectory.csv, commands.csv,
/// summary.json), stages.csv and, in step with the camera, encoders.csv in place of the true path.
void SaveDrive(const std::filesystem::path& folder, const experiment::Experiment& experiment,
               const DriveRun& run);

}  // namespace rift::commands
