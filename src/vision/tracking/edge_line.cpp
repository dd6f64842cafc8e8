#include "edge_line.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "rift/statistics/descriptive.hpp"

namespace rift::vision {
namespace {

constexpr int kRounds = 3;

EdgeLine LeastSquares(const std::vector<Eigen::Vector2d>& points) {
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& p : points) mean += p;
  mean /= static_cast<double>(points.size());
  double xx = 0.0, xy = 0.0, yy = 0.0;
  for (const Eigen::Vector2d& p : points) {
    const Eigen::Vector2d d = p - mean;
    xx += d.x() * d.x();
    xy += d.x() * d.y();
    yy += d.y() * d.y();
  }
  const double along = 0.5 * std::atan2(2.0 * xy, xx - yy);
  EdgeLine line{.normal = {-std::sin(along), std::cos(along)}, .middle = mean};
  line.offset = line.normal.dot(mean);
  line.count = static_cast<int>(points.size());
  line.length2 = xx + yy;  // the part across is nothing beside it
  double sum = 0.0;
  for (const Eigen::Vector2d& p : points) sum += line.Distance(p) * line.Distance(p);
  line.rms = std::sqrt(sum / static_cast<double>(points.size()));
  return line;
}

double MedianDistance(const EdgeLine& line, const std::vector<Eigen::Vector2d>& points) {
  std::vector<double> distances;
  distances.reserve(points.size());
  for (const Eigen::Vector2d& p : points) distances.push_back(std::abs(line.Distance(p)));
  return statistics::Median(std::move(distances));
}

/// Neighbouring edge points share pixels: a line through n of them is as good as one through n of
/// this fraction. Points at every pixel of a bilinear interpolation: 1 + 2 / 4.
constexpr double kSharedPixels = 1.5;

/// One variance of an edge point for all four sides, since each alone has few.
double PointVariance_px2(const std::array<EdgeLine, 4>& sides) {
  double sum = 0.0;
  int free = 0;
  for (const EdgeLine& line : sides) {
    sum += line.rms * line.rms * line.count;
    free += line.count - 2;
  }
  return free > 0 ? sum / free : sum;
}

/// Short profiles end before the blur of the lens does, so that all edges of a small tag shift
/// together with its place among the pixels. Measured on rendered tags of 20 to 60 px and 8 cells:
/// the shift falls with the cube of the shortest side, so with that of a cell, which is as long as
/// the profiles.
CornerCovariance SharedCovariance(const std::array<Eigen::Vector2d, 4>& corners_px,
                                  const EdgeErrors& errors) {
  const double side_px = 2.5 * errors.cells;
  double shortest_px = HUGE_VAL;
  for (int i = 0; i < 4; ++i) {
    shortest_px = std::min(shortest_px, (corners_px[(i + 1) % 4] - corners_px[i]).norm());
  }
  const double sigma_px = errors.shared_px * std::pow(side_px / shortest_px, 3);
  CornerCovariance covariance;
  for (int i = 0; i < 8; ++i) {
    for (int k = 0; k < 8; ++k) covariance(i, k) = i % 2 == k % 2 ? sigma_px * sigma_px : 0.0;
  }
  return covariance;
}

CornerCovariance CovarianceOf(const std::array<EdgeLine, 4>& sides,
                              const std::array<Eigen::Vector2d, 4>& corners_px,
                              double point_variance_px2, const EdgeErrors& errors) {
  const double variance = kSharedPixels * point_variance_px2;
  Eigen::Matrix<double, 8, 8> corners_by_sides = Eigen::Matrix<double, 8, 8>::Zero();
  Eigen::Matrix<double, 8, 1> variances;
  for (int i = 0; i < 4; ++i) {
    variances(2 * i) = variance / sides[i].count;
    variances(2 * i + 1) = variance / sides[i].length2;
    const int before = (i + 3) % 4;
    Eigen::Matrix2d normals;
    normals << sides[before].normal.transpose(), sides[i].normal.transpose();
    const Eigen::Matrix2d meet = normals.inverse();
    int row = 0;
    for (const int side : {before, i}) {
      const EdgeLine& line = sides[side];
      const Eigen::Vector2d along(line.normal.y(), -line.normal.x());
      corners_by_sides.block<2, 1>(2 * i, 2 * side) = meet.col(row);
      corners_by_sides.block<2, 1>(2 * i, 2 * side + 1) =
          meet.col(row) * along.dot(corners_px[i] - line.middle);
      ++row;
    }
  }
  return corners_by_sides * variances.asDiagonal() * corners_by_sides.transpose() +
         errors.corner_px * errors.corner_px * CornerCovariance::Identity() +
         SharedCovariance(corners_px, errors);
}

}  // namespace

std::optional<EdgeLine> FitLine(const std::vector<Eigen::Vector2d>& points, double least_sigma) {
  if (points.size() < 4) return std::nullopt;
  std::vector<Eigen::Vector2d> kept = points;
  EdgeLine line = LeastSquares(kept);
  for (int round = 0; round < kRounds; ++round) {
    const double limit = 3.0 * std::max(least_sigma, statistics::kSigmaOfMedianDeviation *
                                                         MedianDistance(line, points));
    kept.clear();
    std::copy_if(points.begin(), points.end(), std::back_inserter(kept),
                 [&](const Eigen::Vector2d& p) { return std::abs(line.Distance(p)) <= limit; });
    line = LeastSquares(kept);
    if (kept.size() == points.size()) break;
  }
  return line;
}

std::optional<Eigen::Vector2d> Meet(const EdgeLine& a, const EdgeLine& b) {
  Eigen::Matrix2d normals;
  normals << a.normal.transpose(), b.normal.transpose();
  if (std::abs(normals.determinant()) < 0.1) return std::nullopt;
  return normals.inverse() * Eigen::Vector2d(a.offset, b.offset);
}

CornerCovariance CovarianceOf(const std::array<EdgeLine, 4>& sides,
                              const std::array<Eigen::Vector2d, 4>& corners_px,
                              const EdgeErrors& errors) {
  return CovarianceOf(sides, corners_px, PointVariance_px2(sides), errors);
}

}  // namespace rift::vision
