#include "rift/hardware/operator.hpp"

#include <poll.h>
#include <termios.h>
#include <unistd.h>

#include <stdexcept>
#include <utility>

namespace rift::hardware {

struct OperatorKeys::Saved {
  termios settings;
};

OperatorKeys::OperatorKeys() {
  termios settings{};
  if (::isatty(STDIN_FILENO) == 0 || ::tcgetattr(STDIN_FILENO, &settings) != 0) return;
  saved_ = std::make_unique<Saved>(Saved{settings});
  settings.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);  // signals stay: Ctrl-C must work
  settings.c_cc[VMIN] = 0;
  settings.c_cc[VTIME] = 0;
  ::tcsetattr(STDIN_FILENO, TCSANOW, &settings);
}

OperatorKeys::~OperatorKeys() {
  if (saved_) ::tcsetattr(STDIN_FILENO, TCSANOW, &saved_->settings);
}

std::optional<char> OperatorKeys::Pressed() {
  if (!saved_) return std::nullopt;
  pollfd wanted{STDIN_FILENO, POLLIN, 0};
  char key = 0;
  if (::poll(&wanted, 1, 0) <= 0 || ::read(STDIN_FILENO, &key, 1) != 1) return std::nullopt;
  return key;
}

Operator::Operator(bool says_yes) {
  if (says_yes) {
    phase_ = Phase::kStarted;
  } else if (!keys_.IsTerminal()) {
    throw std::invalid_argument(
        "stdin is no terminal, so no key can start the robot: give --yes to start it at once");
  }
}

bool Operator::MayArm(const std::function<void(const std::string&)>& say) {
  Phase expected = Phase::kWaiting;
  if (phase_.compare_exchange_strong(expected, Phase::kAsked)) {
    say("hands off? Enter starts the robot, then any key stops it (before: q gives up)");
  }
  return phase_ == Phase::kStarted;
}

hardware::Stopper Operator::Stopper() {
  return [this] { return Stop(); };
}

std::optional<std::pair<StopReason, std::string>> Operator::Stop() {
  if (const auto signal = signals_.Seen()) return std::pair(StopReason::kSignal, *signal + " came");
  if (window_closed_) return std::pair(StopReason::kOperator, std::string("the window was closed"));
  while (const std::optional<char> key = keys_.Pressed()) TakeKey(*key);
  if (key_stops_) return std::pair(StopReason::kOperator, std::string("a key was pressed"));
  return std::nullopt;
}

// Enter counts once it was asked for; what was typed before must neither start nor stop.
void Operator::TakeKey(char key) {
  const bool is_enter = key == '\n' || key == '\r';
  Phase expected = Phase::kAsked;
  if (is_enter && phase_.compare_exchange_strong(expected, Phase::kStarted)) return;
  if (phase_ == Phase::kStarted || key == 'q') key_stops_ = true;
}

}  // namespace rift::hardware
