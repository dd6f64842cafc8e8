#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

namespace rift::vision {

/// normal . p = offset, with a unit normal.
struct EdgeLine {
  Eigen::Vector2d normal;
  double offset = 0.0;
  double rms = 0.0;  ///< distance of the points that were kept

  double Distance(const Eigen::Vector2d& point) const { return normal.dot(point) - offset; }
};

/// The line with the least squared distances, after points further than 3 sigma (by the median, at
/// least `least_sigma`) are left out. None when fewer than half of the points are left.
std::optional<EdgeLine> FitLine(const std::vector<Eigen::Vector2d>& points, double least_sigma);

/// Where they meet; none when they are all but parallel.
std::optional<Eigen::Vector2d> Meet(const EdgeLine& a, const EdgeLine& b);

}  // namespace rift::vision
