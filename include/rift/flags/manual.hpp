#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace rift::flags {

/// What a packaged program brings along, made from the very options that it parses: `app` is rift
/// with every subcommand and all its options.

/// A man page (groff, section 1) of rift itself, or of the subcommand `name`.
std::string ManPage(const CLI::App& app, const std::string& name = "");

/// Completion of subcommands, flags and the words that a flag takes; file names elsewhere.
std::string BashCompletion(const CLI::App& app);
std::string ZshCompletion(const CLI::App& app);

}  // namespace rift::flags
