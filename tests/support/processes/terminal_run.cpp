#include "support/processes/terminal_run.hpp"

#include <poll.h>
#include <pty.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <stdexcept>

#include "support/processes/child_end.hpp"
#include "support/tree.hpp"
#include "support/until.hpp"

namespace rift::test {
namespace {

/// Its exit code, or 128 + signal.
int Ended(pid_t process) {
  const int status = EndOf(process, "rift, which has left its terminal");
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

/// What is shown until every process at the terminal has ended; false when that takes too long.
bool Watch(int terminal, std::string& shown,
           const std::function<std::string(const std::string&)>& type) {
  const auto end = std::chrono::steady_clock::now() + kGiveUp;
  std::array<char, 4096> block;
  while (std::chrono::steady_clock::now() < end) {
    pollfd wanted{terminal, POLLIN, 0};
    if (::poll(&wanted, 1, 100) <= 0) continue;
    const ssize_t got = ::read(terminal, block.data(), block.size());
    if (got <= 0) return true;
    shown.append(block.data(), static_cast<std::size_t>(got));
    const std::string keys = type ? type(shown) : "";
    if (!keys.empty() && ::write(terminal, keys.data(), keys.size()) < 0) return true;
  }
  return false;
}

}  // namespace

std::size_t TerminalRun::LongestInPlace(const std::string& beginning) const {
  const std::string clear = "\r\x1b[K";
  std::size_t longest = 0;
  for (std::size_t at = shown.find(clear + beginning); at != shown.npos;
       at = shown.find(clear + beginning, at + 1)) {
    const std::size_t begin = at + clear.size();
    const std::string text = shown.substr(begin, shown.find_first_of("\r\n", begin) - begin);
    const auto continues = [](char c) { return (static_cast<unsigned char>(c) & 0xC0) == 0x80; };
    longest = std::max(longest, text.size() - static_cast<std::size_t>(std::count_if(
                                                  text.begin(), text.end(), continues)));
  }
  return longest;
}

TerminalRun RunInTerminal(const std::vector<std::string>& arguments, int columns,
                          const std::function<std::string(const std::string&)>& type) {
  std::vector<std::string> words{RiftBinary()};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  const winsize size{.ws_row = 24, .ws_col = static_cast<unsigned short>(columns)};
  int terminal = -1;
  const pid_t process = ::forkpty(&terminal, nullptr, nullptr, &size);
  if (process < 0) throw std::runtime_error("no terminal to be had");
  if (process == 0) {
    ::execv(argv[0], argv.data());
    ::_exit(127);
  }
  TerminalRun run;
  const bool is_over = Watch(terminal, run.shown, type);
  if (!is_over) ::kill(process, SIGKILL);
  ::close(terminal);
  run.exit_code = Ended(process);
  if (!is_over) throw std::runtime_error("waited in vain for its end; it showed\n" + run.shown);
  return run;
}

}  // namespace rift::test
