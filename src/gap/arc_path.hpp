#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "rift/gap/options.hpp"
#include "rift/geometry/pose2.hpp"
#include "rift/geometry/pose3.hpp"
#include "rift/trajectory/trajectory.hpp"

namespace rift::gap {

// Everything along a path is written once for N coordinates: 2 in the plane, 3 in space.

template <int N>
using Point = Eigen::Matrix<double, N, 1>;
template <int N>
using PointsIn = std::vector<Point<N>>;
using Points = PointsIn<2>;

template <int N>
Point<N> PositionOf(const trajectory::StampedPose& pose) {
  if constexpr (N == 2)
    return pose.Position();
  else
    return pose.PositionInSpace();
}

/// A rigid motion of N coordinates, and the same for many points.
template <int N>
struct MotionIn;
template <>
struct MotionIn<2> {
  using Pose = geometry::Pose2;
  using OfPoints = geometry::PointMotion;
};
template <>
struct MotionIn<3> {
  using Pose = geometry::Pose3;
  using OfPoints = geometry::PointMotion3;
};
template <int N>
using PoseIn = typename MotionIn<N>::Pose;

/// The rows in which the robot drives: from the last one near the first point to the first one
/// that stays near the last point. The whole log when it never leaves that radius.
struct MovingRange {
  size_t first = 0;
  size_t last = 0;
};

template <int N>
MovingRange FindMoving(std::span<const trajectory::StampedPose> poses, double radius_m);

/// Whether the poses, at least one, never leave that radius of the first: the robot stood.
template <int N>
bool StaysWithin(std::span<const trajectory::StampedPose> poses, double radius_m);

/// Arc length without jitter: what was logged outside that range counts with how far it led. 0 of a
/// robot that stood.
template <int N>
double MovingLength_m(std::span<const trajectory::StampedPose> poses, double radius_m);

/// Of the arc length, which is above zero, what was logged outside that range, jitter of a standing
/// robot; 1 where it stood throughout.
template <int N>
double StandingShare(std::span<const trajectory::StampedPose> poses, double radius_m);

/// A polyline over normalised arc length u (paper, section 3.1): vertex i stands at
/// u[i] = s_i / s_total, and the path is linear in u between vertices.
template <int N>
struct ArcPathIn {
  std::vector<double> u;
  std::vector<trajectory::StampedPose> poses;  ///< one for each vertex
  double length_m = 0.0;

  size_t Size() const { return u.size(); }
  Point<N> Vertex(size_t i) const { return PositionOf<N>(poses[i]); }
};
using ArcPath = ArcPathIn<2>;

/// Throws std::invalid_argument for fewer than two poses, a length that is zero or not finite, and
/// in space for a pose without a height.
template <int N>
ArcPathIn<N> MakeArcPathIn(const trajectory::Trajectory& trajectory, const GapOptions& options);
inline ArcPath MakeArcPath(const trajectory::Trajectory& trajectory, const GapOptions& options) {
  return MakeArcPathIn<2>(trajectory, options);
}

/// Of the way from vertex i, the last one at or before u, to the next; `i` goes on from call to
/// call.
template <int N>
double ShareAt(const ArcPathIn<N>& path, double u, size_t& i) {
  while (i + 2 < path.Size() && path.u[i + 1] <= u) ++i;
  const double span = path.u[i + 1] - path.u[i];
  return span > 0.0 ? (u - path.u[i]) / span : 0.0;
}

/// `count` evenly spaced u from 0 to 1.
std::vector<double> EvenShares(int count);

/// The points at these u, which must not fall.
template <int N>
PointsIn<N> PointsAt(const ArcPathIn<N>& path, const std::vector<double>& shares);

/// The points at `count` evenly spaced u from 0 to 1.
template <int N>
PointsIn<N> Resample(const ArcPathIn<N>& path, int count);

/// In the plane positions and yaws; heights stay. In space positions, and yaws only by a
/// translation: a rotation in space leaves no yaw that could be told from the yaw alone.
void Transform(ArcPathIn<2>& path, const geometry::Pose2& b_from_a);
void Transform(ArcPathIn<3>& path, const geometry::Pose3& b_from_a);

/// The translation that lays the first point of `sim` on the first point of `real`.
template <int N>
PoseIn<N> StartMotion(const ArcPathIn<N>& sim, const ArcPathIn<N>& real);

/// The rigid motion that brings `sim` closest to `real`: least squares over `samples` evenly spaced
/// u (Umeyama 1991, without scale).
template <int N>
PoseIn<N> BestRigidMotion(const ArcPathIn<N>& sim, const ArcPathIn<N>& real, int samples);

/// The same from points that stand at the same u of both; in the plane it has a closed form.
geometry::Pose2 BestRigidMotion(const PointsIn<2>& p_in_sim, const PointsIn<2>& p_in_real);
geometry::Pose3 BestRigidMotion(const PointsIn<3>& p_in_sim, const PointsIn<3>& p_in_real);

/// The motion an option asks for; identity for Align::kNone.
template <int N>
PoseIn<N> AligningMotion(const ArcPathIn<N>& sim, const ArcPathIn<N>& real, Align align,
                         int samples);

}  // namespace rift::gap
