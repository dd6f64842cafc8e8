#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "rift/gap/options.hpp"
#include "rift/geometry/pose2.hpp"
#include "rift/trajectory/trajectory.hpp"

namespace rift::gap {

using Points = std::vector<Eigen::Vector2d>;

/// The rows in which the robot drives: from the last one near the first point to the first one
/// that stays near the last point. The whole log when it never leaves that radius.
struct MovingRange {
  size_t first = 0;
  size_t last = 0;
};

MovingRange FindMoving(std::span<const trajectory::StampedPose> poses, double radius_m);

/// Arc length that was logged outside that range: jitter of a standing robot.
double StandingLength_m(std::span<const trajectory::StampedPose> poses, double radius_m);

/// A planar polyline over normalised arc length u (paper, section 3.1): vertex i stands at
/// u[i] = s_i / s_total, and the path is linear in u between vertices.
struct ArcPath {
  std::vector<double> u;
  std::vector<trajectory::StampedPose> poses;  ///< one for each vertex
  double length_m = 0.0;

  size_t Size() const { return u.size(); }
  Eigen::Vector2d Vertex(size_t i) const { return poses[i].Position(); }
};

/// Throws std::invalid_argument for fewer than two poses or a length that is zero or not finite.
ArcPath MakeArcPath(const trajectory::Trajectory& trajectory, const GapOptions& options);

/// The points at `count` evenly spaced u from 0 to 1.
Points Resample(const ArcPath& path, int count);

/// Positions and yaws; heights stay.
void Transform(ArcPath& path, const geometry::Pose2& b_from_a);

/// The translation that lays the first point of `sim` on the first point of `real`.
geometry::Pose2 StartMotion(const ArcPath& sim, const ArcPath& real);

/// The planar rigid motion that brings `sim` closest to `real`: least squares over `samples`
/// evenly spaced u; in the plane the fit of Umeyama 1991, without scale, has this closed form.
geometry::Pose2 BestRigidMotion(const ArcPath& sim, const ArcPath& real, int samples);

/// The same from points that stand at the same u of both.
geometry::Pose2 BestRigidMotion(const Points& p_in_sim, const Points& p_in_real);

/// The motion an option asks for; identity for Align::kNone.
geometry::Pose2 AligningMotion(const ArcPath& sim, const ArcPath& real, Align align, int samples);

}  // namespace rift::gap
