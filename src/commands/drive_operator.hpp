#pragma once

#include <atomic>
#include <functional>
#include <string>

#include "rift/hardware/operator_keys.hpp"
#include "rift/hardware/real_robot.hpp"
#include "rift/hardware/signal_watch.hpp"

namespace rift::commands {

/// Whoever starts and stops a drive: keys of the terminal, signals, the closed window. While it
/// lives, signals do not end the process.
class DriveOperator {
 public:
  /// `says_yes`: the robot may start at once. Throws std::invalid_argument when it may not and
  /// stdin is no terminal, since nobody could ever press a key.
  explicit DriveOperator(bool says_yes);

  /// Asks `say` for the start the first time; then whether it was given.
  bool MayArm(const std::function<void(const std::string&)>& say);
  /// Why the robot must stop; called by the link's thread.
  hardware::Stopper Stopper();
  /// From the window, in place of a key.
  void CloseWindow() { window_closed_ = true; }

 private:
  enum class Phase { kWaiting, kAsked, kStarted };

  std::optional<std::pair<hardware::StopReason, std::string>> Stop();
  void TakeKey(char key);

  hardware::SignalWatch signals_;
  hardware::OperatorKeys keys_;
  std::atomic<Phase> phase_ = Phase::kWaiting;
  std::atomic<bool> window_closed_ = false;
  bool key_stops_ = false;  // the link's thread alone
};

}  // namespace rift::commands
