#pragma once

#include "rift/sessions/drive/setup.hpp"

namespace rift::commands {

/// This process's terminal. Its `ask` takes 'q', Ctrl-C and SIGTERM for giving up; `says_yes`
/// answers Enter at once. It throws std::invalid_argument where stdin is no terminal and nobody
/// says yes.
sessions::Console TerminalConsole(bool says_yes);

}  // namespace rift::commands
