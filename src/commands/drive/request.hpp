#pragma once

#include <optional>
#include <string>
#include <vector>

#include "rift/commands/arguments/arguments.hpp"
#include "rift/sessions/drive/plan.hpp"
#include "rift/sessions/drive/setup.hpp"

namespace rift::commands {

/// What `rift drive` was asked for.
struct DriveRequest {
  std::string experiment;
  std::vector<std::string> overrides;
  sessions::DriveSetup setup;
  sessions::SeriesRequest series;
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

  /// Throws std::invalid_argument, saying what to give, when something is missing.
  void Check() const;
};

/// The words of a command: blanks part them unless they stand between quotes.
std::vector<std::string> WordsOf(const std::string& command);

}  // namespace rift::commands
