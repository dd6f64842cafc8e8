#pragma once

#include <optional>

#include "rift/control/options.hpp"
#include "rift/geometry/pose2.hpp"

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

}  // namespace rift::control
