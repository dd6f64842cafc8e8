#include "rift/control/pose_gate.hpp"

#include <algorithm>
#include <cmath>

#include "rift/geometry/angle.hpp"

namespace rift::control {
namespace {

// Waypoints lie within 1 km; beyond this, squares and differences start to lose their meaning.
constexpr double kFarthest_m = 1e5;

bool IsOnTheMap(const TimedPose& pose) {
  return std::isfinite(pose.captured_s) && pose.world_from_robot.IsFinite() &&
         pose.world_from_robot.Position().cwiseAbs().maxCoeff() < kFarthest_m;
}

}  // namespace

bool PoseGate::Accept(const TimedPose& pose) {
  if (!IsOnTheMap(pose)) return false;
  if (last_ && !IsReachable(pose)) return false;
  last_ = pose;
  return true;
}

bool PoseGate::IsReachable(const TimedPose& pose) const {
  const double elapsed_s = pose.captured_s - last_->captured_s;
  if (elapsed_s < 0.0) return false;
  const double interval_s = std::max(elapsed_s, options_.min_interval_s);
  const geometry::Pose2& before = last_->world_from_robot;
  const double moved_m = (pose.world_from_robot.Position() - before.Position()).norm();
  const double turned_rad =
      std::abs(geometry::WrapToPi(pose.world_from_robot.yaw_rad - before.yaw_rad));
  return moved_m <= options_.max_speed_mps * interval_s &&
         turned_rad <= options_.max_yaw_rate_rad_s * interval_s;
}

}  // namespace rift::control
