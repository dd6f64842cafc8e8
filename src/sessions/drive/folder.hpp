#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "log.hpp"
#include "rift/experiment/experiment.hpp"
#include "rift/hardware/arming.hpp"
#include "rift/vision/camera/camera_model.hpp"

namespace rift::sessions {

/// Throws std::invalid_argument with the name of the first file of a drive that the folder holds,
/// whoever wrote it: a robot does not repeat itself, so a drive replaces nothing.
void RequireNoDrive(const std::filesystem::path& folder);

/// The folder of a drive before the robot moves.
class BegunFolder {
 public:
  explicit BegunFolder(std::filesystem::path folder);
  /// What this has made goes again, unless the drive has begun: Keep(), or a log in the folder.
  ~BegunFolder();
  BegunFolder(const BegunFolder&) = delete;
  BegunFolder& operator=(const BegunFolder&) = delete;

  /// The experiment and the camera (experiment.yaml, camera.yaml), so that a folder that cannot be
  /// written is known in time. Throws std::runtime_error.
  void Write(const experiment::Experiment& experiment, const vision::CameraModel& camera);
  void Keep() { is_kept_ = true; }

 private:
  void WriteOne(const char* name, const std::string& text);

  std::filesystem::path folder_;
  bool was_there_;
  bool is_kept_ = false;
  std::vector<std::filesystem::path> made_;
};

/// From just before the robot drives on, the rest of the run folder: what a simulated run's has
/// (trajectory.csv, commands.csv, a summary.json that says interrupted), stages.csv and, in step
/// with the camera, encoders.csv in place of the true path.
DriveLog::Write WriterInto(const std::filesystem::path& folder,
                           const experiment::Experiment& experiment);

/// Ends the log of a drive, and replaces its summary.json when the log is whole. Returns why it is
/// not; empty when it is.
std::string CloseDrive(const std::filesystem::path& folder,
                       const experiment::Experiment& experiment, const hardware::DriveRun& run,
                       DriveLog& log);

}  // namespace rift::sessions
