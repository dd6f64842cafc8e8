#include "rift/commands/command.hpp"
#include "rift/commands/drive/drive.hpp"
#include "rift/commands/sweep/sweep.hpp"
#include "rift/commands/track/track.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cerrno>
#include <cstring>
#include <sstream>
#include <stdexcept>

#include "rift/flags/manual.hpp"
#include "rift/flags/usage.hpp"
#include "rift/limits/limits.hpp"
#include "rift/terminal/exit_code.hpp"
#include "rift/terminal/print.hpp"
#include "rift/terminal/process_start.hpp"
#include "version.hpp"

namespace rift::commands {

namespace {

using Words = std::vector<std::string>;

/// `rift`, `rift help` and `rift help COMMAND` in the words of flags.
Words WordsOf(int argc, char** argv) {
  Words words(argv + std::min(argc, 1), argv + argc);
  if (words.empty()) return {"--help"};
  if (words.front() != "help") return words;
  words.erase(words.begin());
  if (words.size() > 1) {
    throw std::invalid_argument(
        fmt::format("help takes one subcommand, and there are '{}'", fmt::join(words, "', '")));
  }
  words.emplace_back("--help");
  return words;
}

Words NamesOf(const std::vector<Command>& commands) {
  Words names;
  for (const Command& command : commands) names.push_back(command.name);
  return names;
}

std::string Examples(const std::vector<Command>& commands) {
  std::string text = "Examples:\n";
  for (const Command& command : commands) text += "  " + command.example + "\n";
  return text;
}

int ShowHelp(const CLI::App& app, const CLI::ParseError& error) {
  std::ostringstream text;
  const int exit_code = app.exit(error, text, text);
  terminal::PrintText(text.str());
  return exit_code;
}

/// A key is said to be empty by itself, and a command is for another shell.
flags::ValueRules ValuesOf() {
  return {.with_own_rule = {"--set", "--before-each", "--board"},
          .patterns = {"--camera", "--images"}};
}

int Run(int argc, char** argv, const CameraUses& camera) {
  const std::vector<Command> commands = Commands(camera);
  const Words given(argv + std::min(argc, 1), argv + argc);
  const bool is_manual = given.size() > 1 && given[0] == "help" && given[1].starts_with("--");
  const Words words = is_manual ? Words{"--help"} : WordsOf(argc, argv);
  if (is_manual && given.size() == 3) flags::RequireSubcommand(given[2], NamesOf(commands));
  if (!words.front().starts_with("-")) flags::RequireSubcommand(words.front(), NamesOf(commands));
  int exit_code = terminal::kDone;
  CLI::App app("rift: where a simulator and its robot part ways, and why", "rift");
  app.set_version_flag("-v,--version", VersionText(), "commit and libraries too");
  app.require_subcommand(1);
  app.footer(
      Examples(commands) +
      "\nrift help COMMAND tells the flags of one, rift sweep --keys every key of an experiment.\n"
      "Exit codes: 0 done, 1 falsified (with --exit-code), not reached or a drive stopped, 2 "
      "usage or input, 3 failure, also to write the results, 130 a sweep stopped.");
  for (const Command& command : commands) {
    CLI::App& subcommand = *app.add_subcommand(command.name, command.summary);
    // A word that is not there chooses no subcommand, and options take time to make.
    const bool is_named = std::find(words.begin(), words.end(), command.name) != words.end();
    if (!is_named && !is_manual) continue;
    command.add(subcommand, exit_code);
    subcommand
        .add_flag_callback("--large-inputs", limits::Lift,
                           "take inputs above the limits of docs/limits.md, whatever they cost")
        ->trigger_on_parse();
    flags::RefuseEmptyValues(subcommand, ValuesOf());
  }
  if (is_manual) {
    const std::string manual = flags::Manual(given, app);
    if (manual.empty()) {
      throw std::invalid_argument(given[1] +
                                  ": rift help takes a subcommand, --man, --bash or --zsh");
    }
    terminal::PrintData(manual);
    return terminal::kDone;
  }
  try {
    app.parse(Words(words.rbegin(), words.rend()));  // CLI11 takes them from the back
  } catch (const CLI::ParseError& error) {
    const bool asked_for_help = error.get_exit_code() == 0;
    if (asked_for_help) return ShowHelp(app, error);
    throw std::invalid_argument(flags::UsageError(app, error));
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
       "rift simulate configs/waypoints/paper.yaml --out out/run --figure out/run.svg",
       [camera](CLI::App& app, int& exit_code) { AddSimulate(app, exit_code, camera); }},
      {"track", "Track the robot's tag with a camera, or calibrate the camera",
       "rift track --camera /dev/video0 --calibration cam.yaml --out log.csv",
       [camera](CLI::App& app, int& exit_code) { AddTrack(app, exit_code, camera.track); }},
      {"drive", "Drive the real robot through a waypoint task, or measure its radio link",
       "rift drive --ping --port /dev/rfcomm0",
       [camera](CLI::App& app, int& exit_code) { AddDrive(app, exit_code, camera.drive); }},
      {"gap", "Measure the Sim-to-Real gap of trajectories",
       "rift gap data/example/simulator.csv data/example/robot1.csv data/example/robot2.csv",
       AddGap},
      {"sweep", "Find where in a parameter space the gap is too large, and why",
       "rift sweep configs/waypoints/paper.yaml --out out/paper", AddSweep},
  };
}

}  // namespace rift::commands
