#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "log.hpp"
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
  bool dry_run = false;
  std::optional<double> seconds;  ///< trial.timeout_s of a dry run
  std::optional<double> countdown_s;
  bool any_start = false;
  int repeat = 0;  ///< 0: one drive
  bool grid = false;
  std::string before_each;

  bool IsSeries() const { return grid || repeat > 0; }

  /// Throws std::invalid_argument, saying what to give, when something is missing.
  void Check() const;
};

/// Shows a drive that was: in a window, or as a video. Returns the exit code.
int ReplayDrive(const DriveRequest& request);
/// Port and camera of a robot, open from its first drive to its last.
class DriveSession {
 public:
  /// `request` must outlive it.
  explicit DriveSession(const DriveRequest& request);
  ~DriveSession();
  DriveSession(const DriveSession&) = delete;
  DriveSession& operator=(const DriveSession&) = delete;

  /// Where the next drive finds port, camera and calibration; they are opened then.
  void MoveTo(const std::string& port, const std::string& camera, const std::string& calibration);
  void Close();
  /// Waits for the person's start, drives, and saves the run. Throws std::runtime_error when the
  /// drive cannot begin. After anything but a full trial port and camera are opened anew.
  hardware::DriveRun DriveInto(const std::filesystem::path& folder,
                               const experiment::Experiment& experiment);
  /// Why the last drive's log is not whole; empty when it is.
  const std::string& LogFailure() const { return log_failure_; }
  /// Throws std::runtime_error when it is not.
  void RequireLog() const;

 private:
  class Drivers;

  DriveRequest request_;
  std::string log_failure_;
  std::unique_ptr<Drivers> drivers_;
};

/// The experiment as the request changes it; throws std::invalid_argument, naming the file, when it
/// is no task to drive.
experiment::Experiment LoadTask(const DriveRequest& request);

/// Where its runs go. Throws std::invalid_argument when that holds a single run already.
std::filesystem::path NewFolder(const DriveRequest& request,
                                const experiment::Experiment& experiment);

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
