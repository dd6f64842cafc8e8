#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "rift/commands/arguments/arguments.hpp"
#include "rift/sessions/simulate/run.hpp"

namespace rift::commands {

/// What `rift simulate` was asked for.
struct SimulateRequest {
  std::string experiment;
  std::vector<std::string> overrides;
  std::string start;
  std::string seed;
  std::string out;
  LogCopies copies;
  std::vector<std::string> replay;  ///< folder of a sweep and id of a row
  bool json = false;
  bool twin = false;
  bool force = false;
  bool any_waypoints = false;
  std::string figure;   ///< FILE.svg or FILE.png; empty: none
  std::string video;    ///< FILE.mp4; empty: none
  bool window = false;  ///< of the same film

  /// The log alone, for a pipe.
  bool IsStdout() const { return out == "-"; }
};

/// The experiment of a request; its files become `inputs`. The start and the seed become part of
/// it, so that what is saved is what was run.
experiment::Experiment LoadFor(const SimulateRequest& request,
                               std::vector<std::filesystem::path>& inputs);

/// Throws std::invalid_argument for the folder of a sweep, and for a folder with the name of a
/// file.
void RequireRunName(const std::filesystem::path& out);

/// Throws std::invalid_argument for names of outputs that say no format, that are an input or
/// another output, or that are there already. `out`: where the run goes.
void CheckNames(const SimulateRequest& request, const std::filesystem::path& out,
                const experiment::Experiment& experiment,
                const std::vector<std::filesystem::path>& inputs);

/// Simulates, or replays, and saves the run; then calls `show`, if there is one, and prints the
/// summary. Returns the exit code.
int Simulate(const SimulateRequest& request,
             const std::function<void(const sessions::Simulated&)>& show);

}  // namespace rift::commands
