#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "rift/experiment/experiment.hpp"
#include "rift/hardware/arming.hpp"
#include "rift/sessions/drive/setup.hpp"

namespace rift::sessions {

/// What the robot has to know of an experiment.
hardware::DriveTask DriveTaskOf(const experiment::Experiment& experiment);

/// Why a drive circled or did not arrive, and what to set: a line each.
std::vector<std::string> SteeringLines(const experiment::Experiment& experiment,
                                       const hardware::DriveRun& run);

/// A person ended it: by a key, in the window or by a signal.
bool WasEndedByPerson(const hardware::DriveRun& run);

/// Something ended it that was neither a person, nor its end, nor its time: somebody has to look at
/// the scene.
bool WasEndedByFault(const hardware::DriveRun& run);

/// Port and camera of a robot, open from its first drive to its last.
class DriveSession {
 public:
  DriveSession(DriveSetup setup, Console console);
  ~DriveSession();
  DriveSession(const DriveSession&) = delete;
  DriveSession& operator=(const DriveSession&) = delete;

  /// Where the next drive finds port, camera and calibration; they are opened then.
  void MoveTo(const DriveAddress& address);
  void Close();
  /// Waits for the person's start, drives, and saves the run. A drive that has not begun leaves
  /// nothing. Throws std::runtime_error when it cannot begin, std::invalid_argument when the folder
  /// holds a file of a run. After anything but a full trial port and camera are opened anew.
  hardware::DriveRun DriveInto(const std::filesystem::path& folder,
                               const experiment::Experiment& experiment);
  /// Whether a key, the window or a signal asked for a stop during the last drive, also when that
  /// had arrived by then.
  bool StopWasAsked() const { return stop_was_asked_; }
  /// Why the last drive's log is not whole; empty when it is.
  const std::string& LogFailure() const { return log_failure_; }
  /// Throws std::runtime_error when it is not.
  void RequireLog() const;

 private:
  class Drivers;

  DriveSetup setup_;
  Console console_;
  std::string log_failure_;
  bool stop_was_asked_ = false;
  std::unique_ptr<Drivers> drivers_;
};

}  // namespace rift::sessions
