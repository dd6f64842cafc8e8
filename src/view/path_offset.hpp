#pragma once

#include <Eigen/Core>
#include <limits>
#include <string>
#include <vector>

namespace rift::view {

/// From points of a trail, some centimetres apart, to the nearest point of the path.
struct LateralLine {
  Eigen::Vector2d from_m, to_m;

  double Length_m() const { return (to_m - from_m).norm(); }
};
std::vector<LateralLine> LateralLines(const std::vector<Eigen::Vector2d>& trail_m,
                                      const std::vector<Eigen::Vector2d>& path_m);

/// How far a point lies off the nearest point of the path, left of its direction positive; NaN for
/// a path of fewer than two points.
double PathOffset_m(const Eigen::Vector2d& p_m, const std::vector<Eigen::Vector2d>& path_m);

/// "3.2 mm left"; "-" for NaN.
std::string OffsetText(double offset_m);

}  // namespace rift::view
