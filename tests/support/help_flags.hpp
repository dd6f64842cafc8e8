#pragma once

#include <regex>
#include <set>
#include <string>
#include <vector>

#include "support/processes/process.hpp"

namespace rift::test {

/// The long flags, aliases among them, that the lines of `rift COMMAND --help` begin with; those of
/// rift itself without a command.
inline std::set<std::string> FlagsOf(const std::string& command) {
  const std::vector<std::string> words = command.empty()
                                             ? std::vector<std::string>{"--help"}
                                             : std::vector{command, std::string("--help")};
  const std::string help = RunRift(words).out;
  const std::regex line(R"(\n  (?:-\w,)?(--[a-z-]+(?:,--[a-z-]+)*))"), flag("--[a-z-]+");
  std::set<std::string> flags;
  for (std::sregex_iterator at(help.begin(), help.end(), line), end; at != end; ++at) {
    const std::string names = (*at)[1];
    for (std::sregex_iterator name(names.begin(), names.end(), flag); name != end; ++name) {
      flags.insert(name->str());
    }
  }
  return flags;
}

}  // namespace rift::test
