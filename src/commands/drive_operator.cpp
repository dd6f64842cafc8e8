#include "drive_operator.hpp"

#include <stdexcept>
#include <utility>

namespace rift::commands {

using hardware::StopReason;

DriveOperator::DriveOperator(bool says_yes) {
  if (says_yes) {
    phase_ = Phase::kStarted;
  } else if (!keys_.IsTerminal()) {
    throw std::invalid_argument(
        "stdin is no terminal, so no key can start the robot: give --yes to start it at once");
  }
}

bool DriveOperator::MayArm(const std::function<void(const std::string&)>& say) {
  Phase expected = Phase::kWaiting;
  if (phase_.compare_exchange_strong(expected, Phase::kAsked)) {
    say("hands off? Enter starts the robot, then any key stops it (before: q gives up)");
  }
  return phase_ == Phase::kStarted;
}

hardware::Stopper DriveOperator::Stopper() {
  return [this] { return Stop(); };
}

std::optional<std::pair<StopReason, std::string>> DriveOperator::Stop() {
  if (const auto signal = signals_.Seen()) return std::pair(StopReason::kSignal, *signal + " came");
  if (window_closed_) return std::pair(StopReason::kOperator, std::string("the window was closed"));
  while (const std::optional<char> key = keys_.Pressed()) TakeKey(*key);
  if (key_stops_) return std::pair(StopReason::kOperator, std::string("a key was pressed"));
  return std::nullopt;
}

// Enter counts once it was asked for; what was typed before must neither start nor stop.
void DriveOperator::TakeKey(char key) {
  const bool is_enter = key == '\n' || key == '\r';
  Phase expected = Phase::kAsked;
  if (is_enter && phase_.compare_exchange_strong(expected, Phase::kStarted)) return;
  if (phase_ == Phase::kStarted || key == 'q') key_stops_ = true;
}

}  // namespace rift::commands
