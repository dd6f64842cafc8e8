#include "arc_path.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <span>
#include <stdexcept>

namespace rift::gap {
namespace {

template <int N>
double Distance_m(const trajectory::StampedPose& a, const trajectory::StampedPose& b) {
  return (PositionOf<N>(a) - PositionOf<N>(b)).norm();
}

template <int N>
double Length_m(std::span<const trajectory::StampedPose> poses) {
  double length_m = 0.0;
  for (size_t i = 1; i < poses.size(); ++i) length_m += Distance_m<N>(poses[i], poses[i - 1]);
  return length_m;
}

void RequireHeights(std::span<const trajectory::StampedPose> poses) {
  for (const trajectory::StampedPose& pose : poses) {
    if (!std::isnan(pose.z_m)) continue;
    throw std::invalid_argument(
        fmt::format("the pose at {:g} s has no height z, and the gap in space (dimension xyz) "
                    "needs it: use dimension xy",
                    pose.t_s));
  }
}

template <int N>
void MeasureArcLength(ArcPathIn<N>& path) {
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

template <int N>
Point<N> Centroid(const std::vector<Point<N>>& points) {
  Point<N> sum = Point<N>::Zero();
  for (const Point<N>& point : points) sum += point;
  return sum / static_cast<double>(points.size());
}

}  // namespace

template <int N>
MovingRange FindMoving(std::span<const trajectory::StampedPose> poses, double radius_m) {
  const size_t end = poses.size() - 1;
  size_t first = 0;
  while (first < end && Distance_m<N>(poses[first + 1], poses.front()) <= radius_m) ++first;
  size_t last = end;
  while (last > 0 && Distance_m<N>(poses[last - 1], poses.back()) <= radius_m) --last;
  if (first >= last) return {0, end};
  return {first, last};
}

template <int N>
bool StaysWithin(std::span<const trajectory::StampedPose> poses, double radius_m) {
  return std::all_of(poses.begin(), poses.end(), [&](const trajectory::StampedPose& pose) {
    return Distance_m<N>(pose, poses.front()) <= radius_m;
  });
}

template <int N>
double MovingLength_m(std::span<const trajectory::StampedPose> poses, double radius_m) {
  if (StaysWithin<N>(poses, radius_m)) return 0.0;
  const MovingRange moving = FindMoving<N>(poses, radius_m);
  return Distance_m<N>(poses[moving.first], poses.front()) +
         Length_m<N>(poses.subspan(moving.first, moving.last - moving.first + 1)) +
         Distance_m<N>(poses.back(), poses[moving.last]);
}

template <int N>
double StandingShare(std::span<const trajectory::StampedPose> poses, double radius_m) {
  if (StaysWithin<N>(poses, radius_m)) return 1.0;
  const MovingRange moving = FindMoving<N>(poses, radius_m);
  const double standing_m =
      Length_m<N>(poses.first(moving.first + 1)) + Length_m<N>(poses.subspan(moving.last));
  return standing_m / Length_m<N>(poses);
}

template <int N>
ArcPathIn<N> MakeArcPathIn(const trajectory::Trajectory& trajectory, const GapOptions& options) {
  std::span<const trajectory::StampedPose> poses = trajectory.poses;
  if (poses.size() < 2) {
    throw std::invalid_argument("a path of fewer than two poses has no arc length");
  }
  if constexpr (N == 3) RequireHeights(poses);
  if (options.trim_standstill) {
    const MovingRange moving = FindMoving<N>(poses, options.standstill_radius_m);
    poses = poses.subspan(moving.first, moving.last - moving.first + 1);
  }
  ArcPathIn<N> path;
  path.poses.assign(poses.begin(), poses.end());
  MeasureArcLength(path);
  return path;
}

std::vector<double> EvenShares(int count) {
  std::vector<double> shares;
  shares.reserve(count);
  for (int k = 0; k < count; ++k) shares.push_back(static_cast<double>(k) / (count - 1));
  return shares;
}

template <int N>
PointsIn<N> PointsAt(const ArcPathIn<N>& path, const std::vector<double>& shares) {
  PointsIn<N> points;
  points.reserve(shares.size());
  size_t i = 0;
  for (const double u : shares) {
    const double share = ShareAt(path, u, i);
    points.push_back(path.Vertex(i) + share * (path.Vertex(i + 1) - path.Vertex(i)));
  }
  return points;
}

template <int N>
PointsIn<N> Resample(const ArcPathIn<N>& path, int count) {
  return PointsAt(path, EvenShares(count));
}

void Transform(ArcPathIn<2>& path, const geometry::Pose2& b_from_a) {
  const geometry::PointMotion motion(b_from_a);
  for (trajectory::StampedPose& pose : path.poses) {
    const Eigen::Vector2d p_in_b = motion * pose.Position();
    pose.x_m = p_in_b.x();
    pose.y_m = p_in_b.y();
    pose.yaw_rad += b_from_a.yaw_rad;
  }
}

void Transform(ArcPathIn<3>& path, const geometry::Pose3& b_from_a) {
  const geometry::PointMotion3 motion(b_from_a);
  const bool turns = std::abs(b_from_a.qw) < 1.0;
  for (trajectory::StampedPose& pose : path.poses) {
    const Eigen::Vector3d p_in_b = motion * pose.PositionInSpace();
    pose.x_m = p_in_b.x();
    pose.y_m = p_in_b.y();
    pose.z_m = p_in_b.z();
    if (turns) pose.yaw_rad = trajectory::StampedPose::kNotLogged;
  }
}

template <int N>
PoseIn<N> StartMotion(const ArcPathIn<N>& sim, const ArcPathIn<N>& real) {
  const Point<N> offset_m = real.Vertex(0) - sim.Vertex(0);
  PoseIn<N> motion;
  motion.x_m = offset_m.x();
  motion.y_m = offset_m.y();
  if constexpr (N == 3) motion.z_m = offset_m.z();
  return motion;
}

template <int N>
PoseIn<N> BestRigidMotion(const ArcPathIn<N>& sim, const ArcPathIn<N>& real, int samples) {
  return BestRigidMotion(Resample(sim, samples), Resample(real, samples));
}

geometry::Pose3 BestRigidMotion(const PointsIn<3>& p_in_sim, const PointsIn<3>& p_in_real) {
  const auto count = static_cast<Eigen::Index>(p_in_sim.size());
  const Eigen::Map<const Eigen::Matrix3Xd> sim(p_in_sim.front().data(), 3, count);
  const Eigen::Map<const Eigen::Matrix3Xd> real(p_in_real.front().data(), 3, count);
  const Eigen::Matrix4d motion = Eigen::umeyama(sim, real, false);
  const Eigen::Quaterniond rotation(Eigen::Matrix3d(motion.topLeftCorner<3, 3>()));
  return {motion(0, 3), motion(1, 3), motion(2, 3), rotation.x(),
          rotation.y(), rotation.z(), rotation.w()};
}

geometry::Pose2 BestRigidMotion(const PointsIn<2>& p_in_sim, const PointsIn<2>& p_in_real) {
  const Eigen::Vector2d sim_centre = Centroid<2>(p_in_sim), real_centre = Centroid<2>(p_in_real);
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

template <int N>
PoseIn<N> AligningMotion(const ArcPathIn<N>& sim, const ArcPathIn<N>& real, Align align,
                         int samples) {
  switch (align) {
    case Align::kNone:
      return {};
    case Align::kStart:
      return StartMotion(sim, real);
    case Align::kSe2:
    case Align::kSe3:
      return BestRigidMotion(sim, real, samples);
  }
  return {};
}

template MovingRange FindMoving<2>(std::span<const trajectory::StampedPose>, double);
template bool StaysWithin<2>(std::span<const trajectory::StampedPose>, double);
template double MovingLength_m<2>(std::span<const trajectory::StampedPose>, double);
template double StandingShare<2>(std::span<const trajectory::StampedPose>, double);
template ArcPathIn<2> MakeArcPathIn<2>(const trajectory::Trajectory&, const GapOptions&);
template PointsIn<2> PointsAt<2>(const ArcPathIn<2>&, const std::vector<double>&);
template PointsIn<2> Resample<2>(const ArcPathIn<2>&, int);
template PoseIn<2> StartMotion<2>(const ArcPathIn<2>&, const ArcPathIn<2>&);
template PoseIn<2> BestRigidMotion<2>(const ArcPathIn<2>&, const ArcPathIn<2>&, int);
template PoseIn<2> AligningMotion<2>(const ArcPathIn<2>&, const ArcPathIn<2>&, Align, int);
template MovingRange FindMoving<3>(std::span<const trajectory::StampedPose>, double);
template bool StaysWithin<3>(std::span<const trajectory::StampedPose>, double);
template double MovingLength_m<3>(std::span<const trajectory::StampedPose>, double);
template double StandingShare<3>(std::span<const trajectory::StampedPose>, double);
template ArcPathIn<3> MakeArcPathIn<3>(const trajectory::Trajectory&, const GapOptions&);
template PointsIn<3> PointsAt<3>(const ArcPathIn<3>&, const std::vector<double>&);
template PointsIn<3> Resample<3>(const ArcPathIn<3>&, int);
template PoseIn<3> StartMotion<3>(const ArcPathIn<3>&, const ArcPathIn<3>&);
template PoseIn<3> BestRigidMotion<3>(const ArcPathIn<3>&, const ArcPathIn<3>&, int);
template PoseIn<3> AligningMotion<3>(const ArcPathIn<3>&, const ArcPathIn<3>&, Align, int);

}  // namespace rift::gap
