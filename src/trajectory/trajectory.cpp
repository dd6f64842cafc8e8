#include "rift/trajectory/trajectory.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "rift/geometry/pose2.hpp"
#include "rift/statistics/descriptive.hpp"

namespace rift::trajectory {

bool Trajectory::HasYaw() const {
  return !poses.empty() && std::all_of(poses.begin(), poses.end(), [](const StampedPose& pose) {
    return std::isfinite(pose.yaw_rad);
  });
}

double Trajectory::Duration_s() const {
  return poses.empty() ? 0.0 : poses.back().t_s - poses.front().t_s;
}

double Trajectory::ArcLength_m() const { return trajectory::ArcLength_m(poses); }

double ArcLength_m(std::span<const StampedPose> poses) {
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

namespace {

/// How many of the turns from the first row are those of a standing robot: up to the first two rows
/// after one another that are turned away, since one alone is the tracker's.
size_t StandingRows(const std::vector<double>& turn_rad) {
  constexpr size_t kFirst = 5;  // of which some may jump
  if (turn_rad.size() <= kFirst) return turn_rad.size();
  const double stands_rad = statistics::Median({turn_rad.begin(), turn_rad.begin() + kFirst});
  const auto is_turned = [&](size_t row) {
    return std::abs(geometry::WrapToPi(turn_rad[row] - stands_rad)) > kStandingTurn_rad;
  };
  for (size_t row = kFirst; row + 1 < turn_rad.size(); ++row) {
    if (is_turned(row) && is_turned(row + 1)) return row;
  }
  return turn_rad.size();
}

}  // namespace

geometry::Pose2 StandingPose(const Trajectory& trajectory, double radius_m) {
  if (!trajectory.HasYaw()) {
    throw std::invalid_argument("the pose of the standing robot needs the yaw, which is not known");
  }
  const StampedPose& first = trajectory.poses.front();
  std::vector<double> x_m, y_m, turn_rad;
  for (const StampedPose& pose : trajectory.poses) {
    if ((pose.Position() - first.Position()).norm() > radius_m) break;
    x_m.push_back(pose.x_m);
    y_m.push_back(pose.y_m);
    turn_rad.push_back(geometry::WrapToPi(pose.yaw_rad - first.yaw_rad));
  }
  // The tag over the axle stays where it is while the robot turns on the spot.
  const size_t rows = StandingRows(turn_rad);
  for (std::vector<double>* values : {&x_m, &y_m, &turn_rad}) values->resize(rows);
  return {statistics::Median(x_m), statistics::Median(y_m),
          geometry::WrapToPi(first.yaw_rad + statistics::Median(turn_rad))};
}

}  // namespace rift::trajectory
