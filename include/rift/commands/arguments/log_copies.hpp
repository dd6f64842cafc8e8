#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>
#include <vector>

#include "rift/trajectory/trajectory.hpp"

namespace rift::commands {

/// Files of other programs that a log is written to as well, whichever command made it.
struct LogCopies {
  std::string tum;
  std::string mcap;

  /// Those that were asked for, for CheckOutputs.
  std::vector<std::filesystem::path> Files() const;
};

/// `--tum FILE.tum --mcap FILE.mcap`
void AddLogCopyFlags(CLI::App& app, LogCopies& copies);

void WriteLogCopies(const LogCopies& copies, const trajectory::Trajectory& trajectory);

}  // namespace rift::commands
