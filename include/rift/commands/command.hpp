#pragma once

#include <functional>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace rift::commands {

struct DriveRequest;
struct SimulateRequest;
struct TrackRequest;

/// Everything that needs OpenCV's cameras, windows and video files. Their libraries would cost each
/// start of rift 0.15 s, so only the program rift-camera links them; `rift` runs that one instead
/// (main.cpp). Each returns the exit code.
struct CameraUses {
  std::function<int(const TrackRequest&)> track;
  std::function<int(const DriveRequest&)> drive;
  std::function<int(const SimulateRequest&)> simulate;  ///< with --view, --video or --twin
};

/// The use of simulate itself, for rift-camera.
int SimulateWithCamera(const SimulateRequest& request);

/// One subcommand of rift.
struct Command {
  std::string name;
  std::string summary;  ///< one line, for `rift --help`
  std::string example;  ///< one command line, for `rift --help`
  /// Adds the options; when the command line chose this subcommand, its callback does the work and
  /// leaves the exit code in `exit_code`.
  std::function<void(CLI::App& app, int& exit_code)> add;
};

/// Every subcommand that works, in the order of `rift --help`.
std::vector<Command> Commands(const CameraUses& camera);

void AddGap(CLI::App& app, int& exit_code);
void AddSimulate(CLI::App& app, int& exit_code, const CameraUses& camera);

/// Runs the subcommand that the command line asks for; what it throws is one line on stderr.
/// Returns the exit code.
int RunCommandLine(int argc, char** argv, const CameraUses& camera);

}  // namespace rift::commands
