#include "arc_path.hpp"

#include <cmath>
#include <span>
#include <stdexcept>

#include "rift/geometry/angle.hpp"
#include "standstill.hpp"

namespace rift::gap {
namespace {

void MeasureArcLength(ArcPath& path) {
  path.u.resize(path.x_m.size());
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

void CopyYaw(std::span<const trajectory::StampedPose> poses, ArcPath& path) {
  path.yaw_rad.reserve(poses.size());
  double yaw_rad = poses.front().yaw_rad;
  for (const trajectory::StampedPose& pose : poses) {
    yaw_rad += geometry::WrapToPi(pose.yaw_rad - yaw_rad);
    path.yaw_rad.push_back(yaw_rad);
  }
}

}  // namespace

ArcPath MakeArcPath(const trajectory::Trajectory& trajectory, const GapOptions& options,
                    Columns columns) {
  std::span<const trajectory::StampedPose> poses = trajectory.poses;
  if (poses.size() < 2) {
    throw std::invalid_argument("a path of fewer than two poses has no arc length");
  }
  if (options.trim_standstill) {
    const MovingRange moving = FindMoving(poses, options.standstill_radius_m);
    poses = poses.subspan(moving.first, moving.last - moving.first + 1);
  }
  ArcPath path;
  path.x_m.reserve(poses.size());
  path.y_m.reserve(poses.size());
  for (const trajectory::StampedPose& pose : poses) {
    path.x_m.push_back(pose.x_m);
    path.y_m.push_back(pose.y_m);
  }
  MeasureArcLength(path);
  if (columns == Columns::kPositions) return path;
  path.t_s.reserve(poses.size());
  for (const trajectory::StampedPose& pose : poses) path.t_s.push_back(pose.t_s);
  if (trajectory.HasYaw()) CopyYaw(poses, path);
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
  for (size_t i = 0; i < path.Size(); ++i) {
    const Eigen::Vector2d p_in_b = motion * path.Vertex(i);
    path.x_m[i] = p_in_b.x();
    path.y_m[i] = p_in_b.y();
  }
  for (double& yaw_rad : path.yaw_rad) yaw_rad += b_from_a.yaw_rad;
}

}  // namespace rift::gap
