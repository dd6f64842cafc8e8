#pragma once

#include <optional>
#include <string>
#include <vector>

#include "rift/commands/arguments/log_copies.hpp"
#include "rift/sessions/drive/setup.hpp"

namespace rift::commands {

/// What `rift drive` was asked for.
struct DriveRequest {
  std::string experiment;
  std::vector<std::string> overrides;
  sessions::DriveSetup setup;
  std::string out;
  LogCopies copies;
  std::string replay;  ///< folder of a drive to be shown, without a robot
  std::string video;   ///< of it, FILE.mp4
  bool ping = false;
  bool json = false;
  std::optional<double> seconds;  ///< trial.timeout_s of a dry run
  std::optional<double> countdown_s;
  bool any_waypoints = false;
  bool force = false;  ///< replace the film of --video and the copies of a log
  int repeat = 0;      ///< 0: one drive
  bool grid = false;
  bool identify = false;  ///< drive the program of an identification instead of the waypoints
  std::string suggested;  ///< folder of a sweep whose suggested.yaml is driven
  std::string before_each;

  bool IsSeries() const { return grid || identify || repeat > 0 || !suggested.empty(); }

  /// Throws std::invalid_argument, saying what to give, when something is missing.
  void Check() const;
};

/// The words of a command: blanks part them unless they stand between quotes.
std::vector<std::string> WordsOf(const std::string& command);

}  // namespace rift::commands
