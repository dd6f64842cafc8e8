#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace rift::flags {

/// What the words `help --man [COMMAND]`, `help --bash` and `help --zsh` ask for: a man page
/// (groff, section 1) of rift itself or of a subcommand; completion of subcommands, flags and the
/// words that a flag takes, and of file names elsewhere. Made from the very options that are
/// parsed: `app` is rift with every subcommand and all its options. Empty when the words ask for
/// something else.
std::string Manual(const std::vector<std::string>& words, const CLI::App& app);

}  // namespace rift::flags
