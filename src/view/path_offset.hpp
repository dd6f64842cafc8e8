#pragma once

#include <Eigen/Core>
#include <limits>
#include <string>
#include <vector>

namespace rift::view {

/// The nearest point of a path of two points or more.
Eigen::Vector2d NearestOnPath(const Eigen::Vector2d& p_m,
                              const std::vector<Eigen::Vector2d>& path_m);

/// How far a point lies off the nearest point of the path, left of its direction positive; NaN for
/// a path of fewer than two points.
double PathOffset_m(const Eigen::Vector2d& p_m, const std::vector<Eigen::Vector2d>& path_m);

/// "3.2 mm left"; "-" for NaN.
std::string OffsetText(double offset_m);

}  // namespace rift::view
