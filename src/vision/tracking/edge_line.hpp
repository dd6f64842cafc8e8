#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <optional>
#include <vector>

#include "rift/vision/tracking/tag_pose.hpp"

namespace rift::vision {

/// How much of a side of so many cells is measured: all but a cell at each end, where other edges
/// blur into it.
inline double MeasuredLength_px(double side_px, int cells) { return side_px * (cells - 2) / cells; }
/// How many points that makes at about `step_px` from each other.
inline int PointCount(double side_px, int cells, double step_px) {
  return std::max(6, static_cast<int>(MeasuredLength_px(side_px, cells) / step_px));
}

/// A line through edge points, pixels without the lens: normal . p = offset, with a unit normal.
struct EdgeLine {
  Eigen::Vector2d normal = Eigen::Vector2d::UnitX();
  double offset = 0.0;
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();  ///< of the points that were kept
  int count = 0;                                     ///< of them
  double length2 = 0.0;  ///< sum of their squared distances from the middle, along the line
  double rms = 0.0;      ///< of their distances from the line

  double Distance(const Eigen::Vector2d& point) const { return normal.dot(point) - offset; }
};

/// The line with the least squared distances, after points further than 3 sigma (by the median, at
/// least `least_sigma`) are left out, so never more than half of them. None of fewer than four.
std::optional<EdgeLine> FitLine(const std::vector<Eigen::Vector2d>& points, double least_sigma);

/// Where they meet; none when they are all but parallel.
std::optional<Eigen::Vector2d> Meet(const EdgeLine& a, const EdgeLine& b);

/// What edges are off by without scattering; see TagOptions.
struct EdgeErrors {
  double corner_px = 0.0;  ///< of each corner by itself
  double shared_px = 0.0;  ///< of all four together, of a tag whose cell has 2.5 px
  int cells = 8;           ///< along a side
};

/// Of the corners of a square, pixels squared; corner i is where the sides i - 1 and i meet. A line
/// is known by its offset at the middle of its points and by its direction; both follow from the
/// scatter of the points. What does not scatter is added.
CornerCovariance CovarianceOf(const std::array<EdgeLine, 4>& sides,
                              const std::array<Eigen::Vector2d, 4>& corners_px,
                              const EdgeErrors& errors);

}  // namespace rift::vision
