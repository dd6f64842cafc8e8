#include "progress.hpp"

#include <algorithm>
#include <cmath>

#include "rift/geometry/pose2.hpp"
#include "rift/statistics/descriptive.hpp"

namespace rift::trial {
namespace {

constexpr double kStanding_m = 0.02, kStanding_rad = 0.2;
constexpr double kWindow_s = 0.5;  // in a shorter one less is a robot that moves
constexpr double kLeastNearing_mps = 0.005;

/// Between the 5 % and the 95 % quantile.
double Extent(const std::vector<double>& values) {
  return statistics::Quantile(values, 0.95) - statistics::Quantile(values, 0.05);
}

/// What is left of the task at each pose: to the target, and from there to the last waypoint.
std::vector<double> Left_m(const trajectory::Trajectory& log,
                           const std::vector<control::Waypoint>& waypoints) {
  std::vector<double> after_m(waypoints.size(), 0.0);
  for (size_t i = waypoints.size() - 1; i > 1; --i) {
    after_m[i - 1] = after_m[i] + (waypoints[i].Position() - waypoints[i - 1].Position()).norm();
  }
  std::vector<double> left_m;
  size_t active = 1;
  for (const trajectory::StampedPose& pose : log.poses) {
    const Eigen::Vector2d target_m(pose.target_x_m, pose.target_y_m);
    for (size_t i = active; i < waypoints.size(); ++i) {
      if (waypoints[i].Position() != target_m) continue;
      active = i;
      break;
    }
    left_m.push_back((waypoints[active].Position() - pose.Position()).norm() + after_m[active]);
  }
  return left_m;
}

}  // namespace

double Way_m(const trajectory::Trajectory& log) {
  constexpr double kStride_s = 0.2;
  double way_m = 0.0;
  const trajectory::StampedPose* last = &log.poses.front();
  for (const trajectory::StampedPose& pose : log.poses) {
    if (pose.t_s - last->t_s < kStride_s) continue;
    way_m += (pose.Position() - last->Position()).norm();
    last = &pose;
  }
  return way_m + (log.poses.back().Position() - last->Position()).norm();
}

double Length_m(const std::vector<control::Waypoint>& waypoints) {
  double length_m = 0.0;
  for (size_t i = 1; i < waypoints.size(); ++i) {
    length_m += (waypoints[i].Position() - waypoints[i - 1].Position()).norm();
  }
  return length_m;
}

bool Progress::IsStanding() const {
  return moved_m < kStanding_m * std::min(1.0, last_s / kWindow_s) && turned_rad < kStanding_rad;
}

bool Progress::IsNearing() const { return nearing_mps > kLeastNearing_mps; }

Progress ProgressOf(const TrialResult& result, const std::vector<control::Waypoint>& waypoints) {
  const std::vector<trajectory::StampedPose>& poses = result.trajectory.poses;
  const std::vector<double> left_m = Left_m(result.trajectory, waypoints);
  Progress progress{.took_s = poses.back().t_s - poses.front().t_s, .left_m = left_m.back()};
  const double from_s = poses.back().t_s - progress.took_s / 3.0;
  const auto first = std::find_if(poses.begin(), poses.end(),
                                  [&](const auto& pose) { return pose.t_s >= from_s; });
  const auto begin = std::min(static_cast<size_t>(first - poses.begin()), poses.size() - 2);
  progress.last_s = poses.back().t_s - poses[begin].t_s;
  std::vector<double> x_m, y_m, yaw_rad;
  double turned_rad = 0.0;
  for (size_t i = begin; i < poses.size(); ++i) {
    if (i > begin) turned_rad += geometry::WrapToPi(poses[i].yaw_rad - poses[i - 1].yaw_rad);
    x_m.push_back(poses[i].x_m);
    y_m.push_back(poses[i].y_m);
    yaw_rad.push_back(turned_rad);
  }
  progress.moved_m = std::hypot(Extent(x_m), Extent(y_m));
  progress.turned_rad = Extent(yaw_rad);
  if (progress.took_s > 0.0 && progress.last_s > 0.0) {
    progress.nearing_mps = std::min((left_m.front() - left_m.back()) / progress.took_s,
                                    (left_m[begin] - left_m.back()) / progress.last_s);
  }
  return progress;
}

}  // namespace rift::trial
