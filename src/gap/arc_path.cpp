#include "arc_path.hpp"

#include <cmath>
#include <span>
#include <stdexcept>

namespace rift::gap {
namespace {

double Distance_m(const trajectory::StampedPose& a, const trajectory::StampedPose& b) {
  return (a.Position() - b.Position()).norm();
}

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

Eigen::Vector2d Centroid(const Points& points) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& point : points) sum += point;
  return sum / static_cast<double>(points.size());
}

}  // namespace

MovingRange FindMoving(std::span<const trajectory::StampedPose> poses, double radius_m) {
  const size_t end = poses.size() - 1;
  size_t first = 0;
  while (first < end && Distance_m(poses[first + 1], poses.front()) <= radius_m) ++first;
  size_t last = end;
  while (last > 0 && Distance_m(poses[last - 1], poses.back()) <= radius_m) --last;
  if (first >= last) return {0, end};
  return {first, last};
}

double StandingLength_m(std::span<const trajectory::StampedPose> poses, double radius_m) {
  const MovingRange moving = FindMoving(poses, radius_m);
  return trajectory::ArcLength_m(poses.first(moving.first + 1)) +
         trajectory::ArcLength_m(poses.subspan(moving.last));
}

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
  path.poses.assign(poses.begin(), poses.end());
  MeasureArcLength(path);
  return path;
}

Points Resample(const ArcPath& path, int count) {
  Points points;
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
  for (trajectory::StampedPose& pose : path.poses) {
    const Eigen::Vector2d p_in_b = motion * pose.Position();
    pose.x_m = p_in_b.x();
    pose.y_m = p_in_b.y();
    pose.yaw_rad += b_from_a.yaw_rad;
  }
}

geometry::Pose2 StartMotion(const ArcPath& sim, const ArcPath& real) {
  const Eigen::Vector2d offset_m = real.Vertex(0) - sim.Vertex(0);
  return {offset_m.x(), offset_m.y(), 0.0};
}

geometry::Pose2 BestRigidMotion(const ArcPath& sim, const ArcPath& real, int samples) {
  return BestRigidMotion(Resample(sim, samples), Resample(real, samples));
}

geometry::Pose2 BestRigidMotion(const Points& p_in_sim, const Points& p_in_real) {
  const Eigen::Vector2d sim_centre = Centroid(p_in_sim), real_centre = Centroid(p_in_real);
  double along = 0.0, across = 0.0;
  for (size_t i = 0; i < p_in_sim.size(); ++i) {
    const Eigen::Vector2d a = p_in_sim[i] - sim_centre, b = p_in_real[i] - real_centre;
    along += a.dot(b);
    across += a.x() * b.y() - a.y() * b.x();
  }
  const geometry::Pose2 rotation{0.0, 0.0, std::atan2(across, along)};
  const Eigen::Vector2d offset_m = real_centre - rotation * sim_centre;
  return {offset_m.x(), offset_m.y(), rotation.yaw_rad};
}

geometry::Pose2 AligningMotion(const ArcPath& sim, const ArcPath& real, Align align, int samples) {
  switch (align) {
    case Align::kNone:
      return {};
    case Align::kStart:
      return StartMotion(sim, real);
    case Align::kSe2:
      return BestRigidMotion(sim, real, samples);
  }
  return {};
}

}  // namespace rift::gap
