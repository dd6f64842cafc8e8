#pragma once

#include <filesystem>

namespace CLI {
class App;
}

namespace rift::commands {

void AddSweep(CLI::App& app, int& exit_code);

/// As `rift sweep FILE --out OUT`, with --any-waypoints and --json if asked. Returns the exit code.
int SweepFile(const std::filesystem::path& file, const std::filesystem::path& out,
              bool any_waypoints, bool json);

}  // namespace rift::commands
