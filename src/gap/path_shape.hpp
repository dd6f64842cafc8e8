#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "rift/trajectory/trajectory.hpp"

namespace rift::gap {

/// A path at evenly spaced u, from 0 to 1.
using Shape = std::vector<Eigen::Vector2d>;

Shape ShapeOf(const trajectory::Trajectory& path, int points);

/// The mean point at each u. All shapes have the same number of points, and there is one at least.
Shape MeanShape(std::span<const Shape> shapes);

/// Mean distance at equal u.
double Distance_m(const Shape& a, const Shape& b);

/// Signed distance of each point from the straight line that fits them best.
std::vector<double> LateralResiduals_m(const Shape& shape);

}  // namespace rift::gap
