#pragma once

#include <string>

namespace rift::files {

/// How a process ended, to stand behind its name: "ended by signal 11 (Segmentation fault)", "ended
/// with exit code 3"; with what it said last, "ended with exit code 3: no such friction".
/// `signal` 0: none ended it.
std::string ProcessEndText(int exit_code, int signal, const std::string& last_words);

/// The same of a status as waitpid(2) gives it.
std::string ProcessEndText(int wait_status, const std::string& last_words);

}  // namespace rift::files
