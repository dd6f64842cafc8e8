#pragma once

#include "rift/trial/robot.hpp"

namespace rift::twin {

/// Real time for a simulation: seconds since the start, without those in which the
/// process stood still (SIGSTOP, suspend, overload): it must not catch up on them afterwards.
class Pacer {
 public:
  static constexpr double kMostBehind_s = 0.25;

  explicit Pacer(double start_s) : epoch_s_(start_s), last_s_(start_s) {}

  double Simulated_s(double now_s) {
    const double behind_s = now_s - last_s_;
    if (behind_s > kMostBehind_s) {
      epoch_s_ += behind_s - kMostBehind_s;
      skipped_s_ += behind_s - kMostBehind_s;
    }
    last_s_ = now_s;
    return now_s - epoch_s_;
  }
  /// The moment on the clock at which that simulated second is or was due.
  double ClockOf_s(double simulated_s) const { return epoch_s_ + simulated_s; }
  double Skipped_s() const { return skipped_s_; }

 private:
  double epoch_s_;
  double last_s_;
  double skipped_s_ = 0.0;
};

/// Tells when a trial is over: the robot drove, and its motors have been off for a while since.
class TrialEnd {
 public:
  explicit TrialEnd(double still_s) : still_s_(still_s) {}

  void Observe(double t_s, const control::WheelPower& power) {
    if (power == control::WheelPower{}) return;
    has_driven_ = true;
    driven_s_ = t_s;
  }
  bool HasDriven() const { return has_driven_; }
  bool IsOver(double now_s) const { return has_driven_ && now_s - driven_s_ >= still_s_; }

 private:
  double still_s_;
  bool has_driven_ = false;
  double driven_s_ = 0.0;
};

}  // namespace rift::twin
