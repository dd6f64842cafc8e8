#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace rift::commands {

/// Refuses what no option of a subcommand means: an empty value (a variable of the shell that is
/// not set), a ~ that the shell left as it is, and a value for a flag that takes none.
void RefuseEmptyValues(CLI::App& subcommand);

/// One line: what is wrong with the command line, and what to do.
std::string UsageError(const CLI::App& app, const CLI::ParseError& error);

}  // namespace rift::commands
