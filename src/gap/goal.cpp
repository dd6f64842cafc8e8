#include "rift/gap/goal.hpp"

#include "rift/gap/comparison.hpp"

namespace rift::gap {
namespace {

/// The direction in which a path ends is taken over its last centimetres: the last poses alone may
/// be noise of a robot that stands.
constexpr double kEndOfPath_m = 0.03;

Eigen::Vector2d PositionOf(const trajectory::StampedPose& pose) { return {pose.x_m, pose.y_m}; }

Eigen::Vector2d LastMove_m(const trajectory::Trajectory& path) {
  const Eigen::Vector2d end = PositionOf(path.poses.back());
  for (auto pose = path.poses.rbegin(); pose != path.poses.rend(); ++pose) {
    const Eigen::Vector2d move = end - PositionOf(*pose);
    if (move.norm() >= kEndOfPath_m) return move;
  }
  return end - PositionOf(path.poses.front());
}

trajectory::Trajectory ToTheGoal(const trajectory::Trajectory& path, const Goal& goal) {
  if (path.poses.size() < 2) return path;
  const Eigen::Vector2d left = goal.position_m - PositionOf(path.poses.back());
  const Eigen::Vector2d ahead = LastMove_m(path).normalized();
  const double short_m = left.dot(ahead);
  if (left.norm() > goal.radius_m || !(short_m > 0.0)) return path;
  trajectory::Trajectory longer = path;
  trajectory::StampedPose end = path.poses.back();
  end.t_s += 1.0;  // any later time: the gap knows none
  end.x_m += short_m * ahead.x();
  end.y_m += short_m * ahead.y();
  longer.poses.push_back(end);
  return longer;
}

}  // namespace

double WayGap_m(const trajectory::Trajectory& sim, const trajectory::Trajectory& real,
                const Goal& goal, const GapOptions& options) {
  if (options.IsInSpace()) return Gap(sim, real, options);
  return Gap(ToTheGoal(sim, goal), ToTheGoal(real, goal), options);
}

}  // namespace rift::gap
