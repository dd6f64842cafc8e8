#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "rift/hardware/real_robot.hpp"
#include "rift/hardware/signal_watch.hpp"

namespace rift::hardware {

/// Single key presses from the terminal, without Enter and without echo; nothing where stdin is no
/// terminal. The terminal is as before afterwards.
class OperatorKeys {
 public:
  OperatorKeys();
  ~OperatorKeys();
  OperatorKeys(const OperatorKeys&) = delete;
  OperatorKeys& operator=(const OperatorKeys&) = delete;

  bool IsTerminal() const { return saved_ != nullptr; }
  /// A key pressed since the last call, without waiting.
  std::optional<char> Pressed();

 private:
  struct Saved;
  std::unique_ptr<Saved> saved_;
};

/// Whoever starts and stops a drive: keys of the terminal, signals, the closed window. While it
/// lives, signals do not end the process.
class Operator {
 public:
  /// `says_yes`: the robot may start at once. Throws std::invalid_argument when it may not and
  /// stdin is no terminal, since nobody could ever press a key.
  explicit Operator(bool says_yes);

  /// Asks `say` for the start the first time; then whether it was given.
  bool MayArm(const std::function<void(const std::string&)>& say);
  /// Why the robot must stop; called by the link's thread.
  hardware::Stopper Stopper();
  /// From the window, in place of a key.
  void CloseWindow() { window_closed_ = true; }

 private:
  enum class Phase { kWaiting, kAsked, kStarted };

  std::optional<std::pair<StopReason, std::string>> Stop();
  void TakeKey(char key);

  SignalWatch signals_;
  OperatorKeys keys_;
  std::atomic<Phase> phase_ = Phase::kWaiting;
  std::atomic<bool> window_closed_ = false;
  bool key_stops_ = false;  // the link's thread alone
};

}  // namespace rift::hardware
