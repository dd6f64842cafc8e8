#include "prompt.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cstdio>
#include <stdexcept>
#include <thread>

#include "rift/hardware/arming.hpp"

namespace rift::commands {
namespace {

constexpr std::chrono::milliseconds kPoll{20};
constexpr const char* kClear = "\r\033[K";

std::atomic<bool> is_in_place = false;  // the cursor stands in a line that is to be replaced

}  // namespace

void Say(const std::string& line) {
  fmt::print(stderr, "{}{}\n", is_in_place.exchange(false) ? kClear : "", line);
}

LiveLine::~LiveLine() {
  if (is_in_place.exchange(false)) fmt::print(stderr, "{}", kClear);
}

void LiveLine::Show(const std::string& line) {
  if (::isatty(STDERR_FILENO) == 0) return;
  is_in_place = true;
  fmt::print(stderr, "{}{}", kClear, line);
  std::fflush(stderr);
}

void RingBell() {
  if (::isatty(STDERR_FILENO) == 0) return;
  fmt::print(stderr, "\a");
  std::fflush(stderr);
}

char Ask(const std::string& question, std::string_view keys, bool says_yes) {
  Say(question);
  if (says_yes) return keys.front();
  const hardware::SignalWatch signals;
  hardware::OperatorKeys pressed;
  if (!pressed.IsTerminal()) {
    throw std::invalid_argument(
        "stdin is no terminal, so nobody can answer: give --yes to answer Enter to everything");
  }
  while (!signals.Seen()) {
    const std::optional<char> key = pressed.Pressed();
    if (!key) {
      std::this_thread::sleep_for(kPoll);
    } else if (*key == '\n' || *key == '\r') {
      return keys.front();
    } else if (*key == 'q' || keys.find(*key) != std::string_view::npos) {
      return *key;
    }
  }
  return 'q';
}

}  // namespace rift::commands
