#include "rift/trajectory/trajectory.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace rift::trajectory {

bool Trajectory::HasYaw() const {
  return !poses.empty() && std::all_of(poses.begin(), poses.end(), [](const StampedPose& pose) {
    return std::isfinite(pose.yaw_rad);
  });
}

double Trajectory::Duration_s() const {
  return poses.empty() ? 0.0 : poses.back().t_s - poses.front().t_s;
}

double Trajectory::ArcLength_m() const {
  double length_m = 0.0;
  for (size_t i = 1; i < poses.size(); ++i) {
    length_m += (poses[i].Position() - poses[i - 1].Position()).norm();
  }
  return length_m;
}

Trajectory OffsetAlongHeading(Trajectory trajectory, double offset_m) {
  if (offset_m == 0.0) return trajectory;
  if (!trajectory.HasYaw()) {
    throw std::invalid_argument(
        "a tag offset shifts the path along the yaw, and the yaw is not known");
  }
  for (StampedPose& pose : trajectory.poses) {
    pose.x_m += offset_m * std::cos(pose.yaw_rad);
    pose.y_m += offset_m * std::sin(pose.yaw_rad);
  }
  return trajectory;
}

}  // namespace rift::trajectory
