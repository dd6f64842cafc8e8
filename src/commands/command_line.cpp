#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <stdexcept>

#include "rift/commands/command.hpp"
#include "rift/yaml/node.hpp"
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

int Run(int argc, char** argv, const CameraUses& camera) {
  const std::vector<Command> commands = Commands(camera);
  CheckSubcommand(argc, argv, commands);
  int exit_code = kDone;
  CLI::App app("rift: where a simulator and its robot part ways, and why");
  app.set_version_flag("--version", "rift " RIFT_VERSION);
  app.require_subcommand(1);
  app.footer(
      "Exit codes: 0 done, 1 falsified (with --exit-code) or not reached, 2 usage or input, 3 "
      "failure.");
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
    if (asked_for_help) return app.exit(error);
    throw std::invalid_argument(error.what());
  }
  if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) {
    throw std::runtime_error("cannot write to stdout: the results are lost");
  }
  return exit_code;
}

int Fail(const char* what, int exit_code) {
  fmt::print(stderr, "rift: {}\n", what);
  return exit_code;
}

}  // namespace

int RunCommandLine(int argc, char** argv, const CameraUses& camera) {
  try {
    return Run(argc, argv, camera);
  } catch (const std::invalid_argument& error) {
    return Fail(error.what(), kBadInput);
  } catch (const yaml::Error& error) {
    return Fail(error.what(), kBadInput);
  } catch (const std::exception& error) {
    return Fail(error.what(), kRunTimeFailure);
  }
}

}  // namespace rift::commands
