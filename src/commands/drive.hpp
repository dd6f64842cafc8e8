#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "drive_log.hpp"
#include "rift/experiment/experiment.hpp"
#include "rift/hardware/arming.hpp"
#include "rift/vision/camera/camera_model.hpp"
#include "rift/vision/tracking/session_options.hpp"

namespace rift::commands {

/// What `rift drive` was asked for.
struct DriveRequest {
  std::string experiment;
  std::vector<std::string> overrides;
  std::string port;
  std::string camera;
  std::string calibration;
  std::string out;
  std::string replay;              ///< folder of a drive to be shown, without a robot
  std::string video;               ///< of it, FILE.mp4
  vision::SessionOptions session;  ///< of it moved_m
  bool view = false;
  bool yes = false;
  bool ping = false;
  bool json = false;

  /// Throws std::invalid_argument, saying what to give, when something is missing.
  void Check() const;
};

/// Shows a drive that was: in a window, or as a video. Returns the exit code.
int ReplayDrive(const DriveRequest& request);

/// What the robot has to know of an experiment.
hardware::DriveTask TaskOf(const experiment::Experiment& experiment);

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

}  // namespace rift::commands
