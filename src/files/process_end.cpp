#include "rift/files/process_end.hpp"

#include <fmt/format.h>
#include <sys/wait.h>

#include <cstring>

namespace rift::files {

std::string ProcessEndText(int exit_code, int signal, const std::string& last_words) {
  const std::string end = signal != 0
                              ? fmt::format("ended by signal {} ({})", signal, ::strsignal(signal))
                              : fmt::format("ended with exit code {}", exit_code);
  return last_words.empty() ? end : fmt::format("{}: {}", end, last_words);
}

std::string ProcessEndText(int wait_status, const std::string& last_words) {
  const int signal = WIFSIGNALED(wait_status) ? WTERMSIG(wait_status) : 0;
  return ProcessEndText(WEXITSTATUS(wait_status), signal, last_words);
}

}  // namespace rift::files
