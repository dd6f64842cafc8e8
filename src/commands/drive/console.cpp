#include "console.hpp"

#include <chrono>
#include <stdexcept>
#include <thread>

#include "rift/hardware/arming.hpp"
#include "rift/terminal/print.hpp"

namespace rift::commands {
namespace {

constexpr std::chrono::milliseconds kPoll{20};

char Ask(const std::string& question, std::string_view keys, bool says_yes) {
  terminal::Say(question);
  if (says_yes) return keys.front();
  const hardware::SignalWatch signals;
  hardware::OperatorKeys pressed;
  if (!pressed.IsTerminal()) {
    throw std::invalid_argument(
        "stdin is no terminal, so nobody can answer: give --yes to answer Enter to everything");
  }
  while (!signals.Seen() && !pressed.IsGone()) {
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

}  // namespace

sessions::Console TerminalConsole(bool says_yes) {
  return {.say = terminal::Say,
          .show = terminal::LiveLine::Show,
          .hide = terminal::LiveLine::Hide,
          .ring = terminal::RingBell,
          .ask = [says_yes](const std::string& question, std::string_view keys) {
            return Ask(question, keys, says_yes);
          }};
}

}  // namespace rift::commands
