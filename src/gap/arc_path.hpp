#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "rift/gap/options.hpp"
#include "rift/geometry/pose2.hpp"
#include "rift/trajectory/trajectory.hpp"

namespace rift::gap {

/// A planar polyline over normalised arc length u (paper, section 3.1): vertex i stands at
/// u[i] = s_i / s_total, and the path is linear in u between vertices. The trajectory it is made of
/// must outlive it: its poses are copied only to be moved.
struct ArcPath {
  ArcPath() = default;
  ArcPath(ArcPath&&) = default;
  ArcPath& operator=(ArcPath&&) = default;

  std::vector<double> u;
  std::span<const trajectory::StampedPose> poses;  ///< one for each vertex
  std::vector<trajectory::StampedPose> moved;      ///< what `poses` shows once the path was moved
  double length_m = 0.0;

  size_t Size() const { return u.size(); }
  Eigen::Vector2d Vertex(size_t i) const { return poses[i].Position(); }
};

/// Throws std::invalid_argument for fewer than two poses or a length that is zero or not finite.
ArcPath MakeArcPath(const trajectory::Trajectory& trajectory, const GapOptions& options);

/// The points at `count` evenly spaced u from 0 to 1.
std::vector<Eigen::Vector2d> Resample(const ArcPath& path, int count);

/// Positions and yaws; heights stay.
void Transform(ArcPath& path, const geometry::Pose2& b_from_a);

}  // namespace rift::gap
