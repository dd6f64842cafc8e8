#include "rift/control/pose_predictor.hpp"

#include <algorithm>

namespace rift::control {
namespace {

// A pose older than this is long refused as stale, so no command before it is asked for.
constexpr double kLongestPoseHeld_s = 5.0;

}  // namespace

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
  if (delay_s_ <= 0.0) return world_from_robot;
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
