#pragma once

#include <CLI/CLI.hpp>

namespace rift::commands {

/// `--keys`: lists every key that an experiment can have, and ends.
void AddKeysFlag(CLI::App& app);

}  // namespace rift::commands
