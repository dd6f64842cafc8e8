#pragma once

#include <deque>
#include <optional>

#include "rift/control/diff_drive.hpp"
#include "rift/control/options.hpp"
#include "rift/geometry/pose2.hpp"

/// What becomes of a measured pose before the controller uses it.
namespace rift::control {

struct TimedPose {
  double captured_s = 0.0;
  geometry::Pose2 world_from_robot;
};

/// Believes a pose when it is finite, not older than the last one believed, and reachable from
/// it. The reachable set grows with time, so a robot that really was moved is believed again.
class PoseGate {
 public:
  explicit PoseGate(const PoseGateOptions& options) : options_(options) {}

  /// True when the pose is believed; it is then the last one.
  bool Accept(const TimedPose& pose);
  const std::optional<TimedPose>& last() const { return last_; }

 private:
  bool IsReachable(const TimedPose& pose) const;

  PoseGateOptions options_;
  std::optional<TimedPose> last_;
};

/// Makes up for a known loop delay: moves a measured pose through the commands that were sent but
/// cannot have shown in it yet.
class PosePredictor {
 public:
  /// Throws std::invalid_argument on a bad robot model.
  explicit PosePredictor(const LatencyOptions& options);

  /// A power sent at `now_s`, which holds until the next one. Times must not run backwards.
  void NoteSent(double now_s, const WheelPower& power);

  /// The pose of the robot at the moment a command sent at `now_s` takes effect, given a pose
  /// that arrived at `arrived_s`: what was sent since `arrived_s` - delay is still to be driven.
  /// Without a delay the pose itself.
  geometry::Pose2 Predict(const geometry::Pose2& world_from_robot, double arrived_s,
                          double now_s) const;

 private:
  struct Sent {
    double sent_s;
    WheelPower power;
  };

  DiffDrive drive_;
  double delay_s_;
  std::deque<Sent> sent_;
};

}  // namespace rift::control
