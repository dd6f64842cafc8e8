#include "rift/trajectory/trajectory.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
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
size_t RowsBeforeTurn(const std::vector<double>& turn_rad) {
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

/// Between the tag's normal and the vertical; NaN where it is not logged.
double Tilt_rad(const StampedPose& pose) {
  return std::acos(std::cos(pose.roll_rad) * std::cos(pose.pitch_rad));
}

double TurnFromFirst_rad(const Trajectory& trajectory, size_t row) {
  return geometry::WrapToPi(trajectory.poses[row].yaw_rad - trajectory.poses.front().yaw_rad);
}

/// Of so many first rows those of the lower tilt, where two tilts take turns before the robot has
/// moved from where the lower one shows it; else all. What follows all others may be a robot that
/// leaves, and is turned.
std::vector<size_t> UprightRows(const Trajectory& trajectory, size_t rows, double radius_m) {
  constexpr double kMirrored_rad = 0.2;  // the authors' logs: 0.3 to 0.5 more
  constexpr double kHardlyMoved = 0.3;   // of the radius
  double least_rad = StampedPose::kNotLogged;
  for (size_t row = 0; row < rows; ++row) {
    least_rad = std::fmin(least_rad, Tilt_rad(trajectory.poses[row]));
  }
  std::vector<size_t> all(rows), upright;
  std::iota(all.begin(), all.end(), 0);
  bool take_turns = false;
  for (const size_t row : all) {
    const StampedPose& pose = trajectory.poses[row];
    const double tilt_rad = Tilt_rad(pose);
    if (tilt_rad > least_rad + kMirrored_rad) take_turns = take_turns || !upright.empty();
    if (!(tilt_rad <= least_rad + kMirrored_rad)) continue;
    const size_t first = upright.empty() ? row : upright.front();
    const double moved_m = (pose.Position() - trajectory.poses[first].Position()).norm();
    if (moved_m <= kHardlyMoved * radius_m) upright.push_back(row);
  }
  return take_turns ? upright : all;
}

/// The rows that show the robot where it stood before it left.
std::vector<size_t> StandingRows(const Trajectory& trajectory, double radius_m) {
  const Eigen::Vector2d first_m = trajectory.poses.front().Position();
  std::vector<double> turn_rad;
  for (size_t row = 0; row < trajectory.poses.size(); ++row) {
    if ((trajectory.poses[row].Position() - first_m).norm() > radius_m) break;
    turn_rad.push_back(TurnFromFirst_rad(trajectory, row));
  }
  // The tag over the axle stays where it is while the robot turns on the spot.
  return UprightRows(trajectory, RowsBeforeTurn(turn_rad), radius_m);
}

}  // namespace

geometry::Pose2 StandingPose(const Trajectory& trajectory, double radius_m) {
  if (!trajectory.HasYaw()) {
    throw std::invalid_argument("the pose of the standing robot needs the yaw, which is not known");
  }
  std::vector<double> x_m, y_m, turn_rad;
  for (const size_t row : StandingRows(trajectory, radius_m)) {
    x_m.push_back(trajectory.poses[row].x_m);
    y_m.push_back(trajectory.poses[row].y_m);
    turn_rad.push_back(TurnFromFirst_rad(trajectory, row));
  }
  return {statistics::Median(x_m), statistics::Median(y_m),
          geometry::WrapToPi(trajectory.poses.front().yaw_rad + statistics::Median(turn_rad))};
}

double StandingTilt_rad(const Trajectory& trajectory, double radius_m) {
  std::vector<double> tilts_rad;
  for (const size_t row : StandingRows(trajectory, radius_m)) {
    const double tilt_rad = Tilt_rad(trajectory.poses[row]);
    if (!std::isnan(tilt_rad)) tilts_rad.push_back(tilt_rad);
  }
  return tilts_rad.empty() ? StampedPose::kNotLogged : statistics::Median(tilts_rad);
}

}  // namespace rift::trajectory
