#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace rift::commands {

/// What the process ends with.
enum ExitCode : int {
  kDone = 0,
  kFalsified = 1,   ///< only with --exit-code
  kNotReached = 1,  ///< a trial ended before the last waypoint
  kBadInput = 2,    ///< usage, configuration or a log
  kRunTimeFailure = 3,
  kStopped = 130,  ///< by Ctrl-C, as shells have it
};

/// One subcommand of rift.
struct Command {
  std::string name;
  std::string summary;  ///< one line, for `rift --help`
  /// Adds the options; when the command line chose this subcommand, its callback does the work and
  /// leaves the exit code in `exit_code`.
  void (*add)(CLI::App& app, int& exit_code);
};

/// Every subcommand that works, in the order of `rift --help`.
const std::vector<Command>& Commands();

void AddDrive(CLI::App& app, int& exit_code);
void AddGap(CLI::App& app, int& exit_code);
void AddSimulate(CLI::App& app, int& exit_code);
void AddSweep(CLI::App& app, int& exit_code);
void AddTrack(CLI::App& app, int& exit_code);

}  // namespace rift::commands
