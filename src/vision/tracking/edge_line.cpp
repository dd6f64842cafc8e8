#include "edge_line.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "rift/statistics/quantile.hpp"

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
  EdgeLine line{{-std::sin(along), std::cos(along)}, 0.0, 0.0};
  line.offset = line.normal.dot(mean);
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
    if (2 * kept.size() < points.size()) return std::nullopt;
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

}  // namespace rift::vision
