#include "rift/control/pose_filter.hpp"

#include <algorithm>
#include <cmath>

#include "rift/geometry/pose2.hpp"

namespace rift::control {
namespace {

// Waypoints lie within 1 km; beyond this, squares and differences start to lose their meaning.
constexpr double kFarthest_m = 1e5;

bool IsOnTheMap(const TimedPose& pose) {
  return std::isfinite(pose.captured_s) && pose.world_from_robot.IsFinite() &&
         pose.world_from_robot.Position().cwiseAbs().maxCoeff() < kFarthest_m;
}

// A pose older than this is long refused as stale, so no command before it is asked for.
constexpr double kLongestPoseHeld_s = 5.0;

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

PosePredictor::PosePredictor(const LatencyOptions& options)
    : drive_(options.drive), delay_s_(options.delay_s) {}

void PosePredictor::NoteSent(double now_s, const WheelPower& power) {
  if (delay_s_ <= 0.0) return;
  sent_.push_back({now_s, power});
  const double oldest_s = now_s - delay_s_ - kLongestPoseHeld_s;
  while (sent_.size() > 1 && sent_[1].sent_s <= oldest_s) sent_.pop_front();
}

geometry::Pose2 PosePredictor::Predict(const geometry::Pose2& world_from_robot, double arrived_s,
                                       double now_s) const {
  geometry::Pose2 predicted = world_from_robot;
  const double unseen_from_s = arrived_s - delay_s_;
  for (size_t i = 0; i < sent_.size(); ++i) {
    const double from_s = std::max(sent_[i].sent_s, unseen_from_s);
    const double to_s = std::min(i + 1 < sent_.size() ? sent_[i + 1].sent_s : now_s, now_s);
    if (to_s > from_s) predicted = drive_.Drive(predicted, sent_[i].power, to_s - from_s);
  }
  return predicted;
}

}  // namespace rift::control
