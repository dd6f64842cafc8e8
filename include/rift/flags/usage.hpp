#pragma once

#include <CLI/CLI.hpp>
#include <initializer_list>
#include <string>
#include <vector>

namespace rift::flags {

/// Options whose values are not as those of others.
struct ValueRules {
  std::vector<std::string> with_own_rule;  ///< whoever reads them says what is wrong
  std::vector<std::string> patterns;       ///< of files: whoever reads them replaces a ~
};

/// Refuses what no option of a subcommand means: an empty value (a variable of the shell that is
/// not set), a ~ that the shell left as it is, and a value for a flag that takes none.
void RefuseEmptyValues(CLI::App& subcommand, const ValueRules& rules);

/// Flags that mean nothing together, or without another.
struct WrongUse {
  bool is_given = false;
  std::string message;  ///< one line: what is wrong and what to do
};

/// Throws std::invalid_argument with the message of the first that is given.
void Refuse(std::initializer_list<WrongUse> uses);

/// CLI11 refuses `flag` beside each of `others`. All of them are flags of `app` already.
void Exclude(CLI::App& app, const char* flag, std::initializer_list<const char*> others);

/// Throws std::invalid_argument, with the nearest of `names` and help, when `word` is none of
/// `names`: CLI11 calls a mistyped subcommand "an argument that was not expected".
void RequireSubcommand(const std::string& word, std::vector<std::string> names);

/// One line: what is wrong with the command line, and what to do.
std::string UsageError(const CLI::App& app, const CLI::ParseError& error);

}  // namespace rift::flags
