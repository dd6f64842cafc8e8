#include "arc_path.hpp"

#include <cmath>
#include <stdexcept>

#include "standstill.hpp"

namespace rift::gap {
namespace {

void MeasureArcLength(ArcPath& path) {
  path.u.resize(path.poses.size());
  path.u[0] = 0.0;
  for (size_t i = 1; i < path.u.size(); ++i) {
    path.u[i] = path.u[i - 1] + (path.Vertex(i) - path.Vertex(i - 1)).norm();
  }
  path.length_m = path.u.back();
  if (path.length_m == 0.0) {
    throw std::invalid_argument("the path has zero length: the robot never moved");
  }
  if (!std::isfinite(path.length_m)) {
    throw std::invalid_argument("the length of the path is not finite: a position is NaN or huge");
  }
  for (double& u : path.u) u /= path.length_m;
}

}  // namespace

ArcPath MakeArcPath(const trajectory::Trajectory& trajectory, const GapOptions& options) {
  std::span<const trajectory::StampedPose> poses = trajectory.poses;
  if (poses.size() < 2) {
    throw std::invalid_argument("a path of fewer than two poses has no arc length");
  }
  if (options.trim_standstill) {
    const MovingRange moving = FindMoving(poses, options.standstill_radius_m);
    poses = poses.subspan(moving.first, moving.last - moving.first + 1);
  }
  ArcPath path;
  path.poses = poses;
  MeasureArcLength(path);
  return path;
}

std::vector<Eigen::Vector2d> Resample(const ArcPath& path, int count) {
  std::vector<Eigen::Vector2d> points;
  points.reserve(count);
  size_t i = 0;
  for (int k = 0; k < count; ++k) {
    const double u = static_cast<double>(k) / (count - 1);
    while (i + 2 < path.Size() && path.u[i + 1] <= u) ++i;
    const double span = path.u[i + 1] - path.u[i];
    const double share = span > 0.0 ? (u - path.u[i]) / span : 0.0;
    points.push_back(path.Vertex(i) + share * (path.Vertex(i + 1) - path.Vertex(i)));
  }
  return points;
}

void Transform(ArcPath& path, const geometry::Pose2& b_from_a) {
  const geometry::PointMotion motion(b_from_a);
  path.moved.assign(path.poses.begin(), path.poses.end());
  for (trajectory::StampedPose& pose : path.moved) {
    const Eigen::Vector2d p_in_b = motion * pose.Position();
    pose.x_m = p_in_b.x();
    pose.y_m = p_in_b.y();
    pose.yaw_rad += b_from_a.yaw_rad;
  }
  path.poses = path.moved;
}

}  // namespace rift::gap
