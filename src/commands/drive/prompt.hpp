#pragma once

#include <string>
#include <string_view>

namespace rift::commands {

/// What a person answers with one key of `keys`; Enter is the first of them. 'q', Ctrl-C and
/// SIGTERM give up: 'q'. `says_yes` answers Enter at once. Throws std::invalid_argument where stdin
/// is no terminal and nobody says yes.
char Ask(const std::string& question, std::string_view keys, bool says_yes);

}  // namespace rift::commands
