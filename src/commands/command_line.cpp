#include "rift/commands/camera_program.hpp"
#include "rift/commands/command.hpp"
#include "rift/commands/drive/drive.hpp"
#include "rift/commands/sweep/sweep.hpp"
#include "rift/commands/track/track.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <sstream>
#include <stdexcept>

#include "rift/terminal/exit_code.hpp"
#include "rift/terminal/print.hpp"
#include "rift/terminal/process_start.hpp"
#include "rift/yaml/suggest.hpp"

namespace rift::commands {

namespace {

/// CLI11 calls a mistyped subcommand "an argument that was not expected".
void CheckSubcommand(int argc, char** argv, const std::vector<Command>& commands) {
  if (argc < 2 || argv[1][0] == '-') return;
  std::vector<std::string> names;
  for (const Command& command : commands) names.push_back(command.name);
  if (std::find(names.begin(), names.end(), argv[1]) != names.end()) return;
  const std::string nearest = yaml::Nearest(argv[1], names);
  throw std::invalid_argument(
      nearest.empty()
          ? fmt::format("'{}' is no subcommand; there are {}", argv[1], fmt::join(names, ", "))
          : fmt::format("'{}' is no subcommand; did you mean '{}'?", argv[1], nearest));
}

int ShowHelp(const CLI::App& app, const CLI::ParseError& error) {
  std::ostringstream text;
  const int exit_code = app.exit(error, text, text);
  terminal::PrintText(text.str());
  return exit_code;
}

int Run(int argc, char** argv, const CameraUses& camera) {
  const std::vector<Command> commands = Commands(camera);
  CheckSubcommand(argc, argv, commands);
  int exit_code = terminal::kDone;
  CLI::App app("rift: where a simulator and its robot part ways, and why");
  app.set_version_flag("--version", "rift " RIFT_VERSION);
  app.require_subcommand(1);
  app.footer(
      "Exit codes: 0 done, 1 falsified (with --exit-code) or not reached, 2 usage or input, 3 "
      "failure, also to write the results.");
  for (const Command& command : commands) {
    CLI::App& subcommand = *app.add_subcommand(command.name, command.summary);
    // A word that is not there chooses no subcommand, and options take time to make.
    if (std::find(argv, argv + argc, std::string_view(command.name)) == argv + argc) continue;
    command.add(subcommand, exit_code);
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    const bool asked_for_help = error.get_exit_code() == 0;
    if (asked_for_help) return ShowHelp(app, error);
    throw std::invalid_argument(error.what());
  }
  return exit_code;
}

/// A reader that went away, as head does, has seen what it wanted and is not told.
int Deliver(int exit_code) {
  const int error = terminal::FlushResults();
  if (error == 0) return exit_code;
  if (error == EPIPE) return terminal::kRunTimeFailure;
  const std::string reason = error == EBADF ? "it is closed" : strerror(error);
  return terminal::Fail("cannot write to stdout: " + reason, terminal::kRunTimeFailure);
}

}  // namespace

int RunCommandLine(int argc, char** argv, const CameraUses& camera) {
  return terminal::ReportErrors([&] {
    terminal::GuardProcessStart();
    return Deliver(Run(argc, argv, camera));
  });
}

std::vector<Command> Commands(const CameraUses& camera) {
  return {
      {"simulate", "Drive the simulated robot through a waypoint task",
       [camera](CLI::App& app, int& exit_code) { AddSimulate(app, exit_code, camera); }},
      {"track", "Track the robot's tag with a camera, or calibrate the camera",
       [camera](CLI::App& app, int& exit_code) { AddTrack(app, exit_code, camera.track); }},
      {"drive", "Drive the real robot through a waypoint task, or measure its radio link",
       [camera](CLI::App& app, int& exit_code) { AddDrive(app, exit_code, camera.drive); }},
      {"gap", "Measure the Sim-to-Real gap of trajectories", AddGap},
      {"sweep", "Find where in a parameter space the gap is too large, and why", AddSweep},
  };
}

namespace fs = std::filesystem;

void RunCameraProgram(char** argv) {
  const fs::path folder = fs::read_symlink("/proc/self/exe").parent_path();
  const fs::path relative = "lib/rift/rift-camera";
  const fs::path in_build = folder / relative;
  const fs::path program = fs::exists(in_build) ? in_build : folder.parent_path() / relative;
  if (!fs::exists(program)) {
    throw std::runtime_error(fmt::format(
        "cameras, windows and videos need the program {}, which is not there: build and install "
        "rift again, with libopencv-dev",
        program.string()));
  }
  ::execv(program.c_str(), argv);
  throw std::runtime_error(fmt::format("cannot run {}: {}", program.string(), strerror(errno)));
}

}  // namespace rift::commands
