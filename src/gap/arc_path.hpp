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
/// must outlive it: time and yaw are not copied.
struct ArcPath {
  std::vector<double> u;
  std::vector<double> x_m;
  std::vector<double> y_m;
  std::span<const trajectory::StampedPose> poses;  ///< where it was logged, one for each vertex
  double turned_rad = 0.0;                         ///< by how much it was turned since
  double length_m = 0.0;

  size_t Size() const { return u.size(); }
  Eigen::Vector2d Vertex(size_t i) const { return {x_m[i], y_m[i]}; }
};

/// Throws std::invalid_argument for fewer than two poses or a length that is zero or not finite.
ArcPath MakeArcPath(const trajectory::Trajectory& trajectory, const GapOptions& options);

/// The points at `count` evenly spaced u from 0 to 1.
std::vector<Eigen::Vector2d> Resample(const ArcPath& path, int count);

void Transform(ArcPath& path, const geometry::Pose2& b_from_a);

}  // namespace rift::gap
