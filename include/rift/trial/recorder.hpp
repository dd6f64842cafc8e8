#pragma once

#include <vector>

#include "rift/control/navigator.hpp"
#include "rift/trial/robot.hpp"
#include "rift/trial/trial.hpp"

namespace rift::trial {

/// Turns the steps of a trial into the evidence of its result.
class Recorder {
 public:
  Recorder(const std::vector<control::Waypoint>& waypoints, double log_period_s);

  /// Once for each believable new pose, after the decision made on it (none while settling).
  void Pose(const PoseMeasurement& measured, const control::Waypoint& target,
            const control::Decision& decision);
  void Sent(double now_s, const control::WheelPower& power);
  /// Once for each decision; `active_after` is the waypoint the navigator drives to from now on.
  void Decided(double now_s, const control::Decision& decision, size_t active_after);
  void Refused() { ++result_.poses_refused; }
  void Stale() { ++result_.stale_decisions; }

  TrialResult& result() { return result_; }

 private:
  enum ChannelIndex { kPowerLeft, kPowerRight, kV, kW };

  double log_period_s_;
  size_t active_ = 1;
  TrialResult result_;
};

}  // namespace rift::trial
