#include "true_path.hpp"

#include <algorithm>
#include <cmath>

#include "rift/geometry/pose2.hpp"

namespace rift::twin {
namespace {

constexpr double kRecent_s = 3.0;
constexpr double kRowPeriod_s = 0.010;
constexpr double kStandingRowPeriod_s = 1.0;
constexpr double kMoved_m = 1e-5;
constexpr double kTurned_rad = 1e-4;

bool HasMoved(const trajectory::StampedPose& row, const simulation::TruePose& pose) {
  return std::hypot(pose.x_m - row.x_m, pose.y_m - row.y_m) > kMoved_m ||
         std::abs(geometry::WrapToPi(pose.yaw_rad - row.yaw_rad)) > kTurned_rad;
}

trajectory::StampedPose RowOf(const simulation::TruePose& pose) {
  return {.t_s = pose.t_s,
          .x_m = pose.x_m,
          .y_m = pose.y_m,
          .z_m = pose.z_m,
          .roll_rad = pose.roll_rad,
          .pitch_rad = pose.pitch_rad,
          .yaw_rad = pose.yaw_rad};
}

TruePath::Moment Between(const simulation::TruePose& before, const simulation::TruePose& after,
                         double t_s) {
  const double span_s = after.t_s - before.t_s;
  const double share = std::clamp((t_s - before.t_s) / span_s, 0.0, 1.0);
  const auto mix = [share](double a, double b) { return a + share * (b - a); };
  const auto turn = [share](double a, double b) { return a + share * geometry::WrapToPi(b - a); };
  return {{t_s, mix(before.x_m, after.x_m), mix(before.y_m, after.y_m), mix(before.z_m, after.z_m),
           turn(before.roll_rad, after.roll_rad), turn(before.pitch_rad, after.pitch_rad),
           turn(before.yaw_rad, after.yaw_rad)},
          (after.x_m - before.x_m) / span_s,
          (after.y_m - before.y_m) / span_s,
          (after.z_m - before.z_m) / span_s,
          geometry::WrapToPi(after.yaw_rad - before.yaw_rad) / span_s};
}

}  // namespace

TruePath::TruePath(const simulation::TruePose& start) : recent_{start} {
  path_.poses.push_back(RowOf(start));
}

void TruePath::Add(const simulation::TruePose& pose) {
  const std::lock_guard lock(mutex_);
  recent_.push_back(pose);
  while (recent_.size() > 2 && recent_[1].t_s < pose.t_s - kRecent_s) recent_.pop_front();
  const trajectory::StampedPose& last = path_.poses.back();
  const double period_s = HasMoved(last, pose) ? kRowPeriod_s : kStandingRowPeriod_s;
  if (pose.t_s - last.t_s >= period_s) path_.poses.push_back(RowOf(pose));
}

TruePath::Moment TruePath::At(double t_s) const {
  const std::lock_guard lock(mutex_);
  if (recent_.size() < 2) return {recent_.front()};
  const auto after = std::clamp(
      std::lower_bound(recent_.begin(), recent_.end(), t_s,
                       [](const simulation::TruePose& pose, double t) { return pose.t_s < t; }),
      recent_.begin() + 1, recent_.end() - 1);
  return Between(*(after - 1), *after, t_s);
}

double TruePath::Newest_s() const {
  const std::lock_guard lock(mutex_);
  return recent_.back().t_s;
}

trajectory::Trajectory TruePath::Path() const {
  const std::lock_guard lock(mutex_);
  return path_;
}

vision::RobotMotion TagOf(const TruePath::Moment& moment, const simulation::MocapOptions& mocap) {
  const simulation::TruePose& pose = moment.pose;
  const Eigen::Matrix3d world_from_robot =
      (Eigen::AngleAxisd(pose.yaw_rad, Eigen::Vector3d::UnitZ()) *
       Eigen::AngleAxisd(pose.pitch_rad, Eigen::Vector3d::UnitY()) *
       Eigen::AngleAxisd(pose.roll_rad, Eigen::Vector3d::UnitX()))
          .toRotationMatrix();
  const Eigen::Vector3d arm =
      world_from_robot * Eigen::Vector3d(mocap.tag_ahead_m, 0.0, mocap.tag_above_m);
  vision::RobotMotion tag;
  tag.world_from_tag.linear() = world_from_robot;
  tag.world_from_tag.translation() = Eigen::Vector3d(pose.x_m, pose.y_m, pose.z_m) + arm;
  tag.velocity_mps = Eigen::Vector3d(moment.vx_mps, moment.vy_mps, moment.vz_mps) +
                     moment.yaw_rate_radps * Eigen::Vector3d::UnitZ().cross(arm);
  tag.yaw_rate_radps = moment.yaw_rate_radps;
  return tag;
}

}  // namespace rift::twin
