#include "measures.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace rift::gap {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

double SquaredDistanceToSegment(const Eigen::Vector2d& p, const Eigen::Vector2d& begin,
                                const Eigen::Vector2d& end) {
  const Eigen::Vector2d along = end - begin;
  const double squared_length = along.squaredNorm();
  const double share =
      squared_length > 0.0 ? std::clamp((p - begin).dot(along) / squared_length, 0.0, 1.0) : 0.0;
  return (begin + share * along - p).squaredNorm();
}

double DirectedHausdorff_m(const Points& from, const Points& to) {
  double largest = 0.0;
  for (const Eigen::Vector2d& p : from) {
    double closest = kInfinity;
    for (size_t i = 1; i < to.size() && closest > largest; ++i) {
      closest = std::min(closest, SquaredDistanceToSegment(p, to[i - 1], to[i]));
    }
    largest = std::max(largest, closest);
  }
  return std::sqrt(largest);
}

Eigen::Vector2d PositionAt(const trajectory::Trajectory& path, double since_start_s, size_t& row) {
  const auto& poses = path.poses;
  const double t_s = poses.front().t_s + since_start_s;
  while (row + 2 < poses.size() && poses[row + 1].t_s <= t_s) ++row;
  const auto &before = poses[row], &after = poses[row + 1];
  const double share = std::clamp((t_s - before.t_s) / (after.t_s - before.t_s), 0.0, 1.0);
  return before.Position() + share * (after.Position() - before.Position());
}

}  // namespace

double Hausdorff_m(const Points& a, const Points& b) {
  return std::max(DirectedHausdorff_m(a, b), DirectedHausdorff_m(b, a));
}

double DiscreteFrechet_m(const Points& a, const Points& b) {
  // Squared distances: the order of maxima and minima is the same, one root at the end.
  std::vector<double> row(b.size() + 1, kInfinity);
  for (size_t i = 0; i < a.size(); ++i) {
    double diagonal = i == 0 ? 0.0 : kInfinity;
    row[0] = kInfinity;
    for (size_t j = 1; j <= b.size(); ++j) {
      const double reach = std::min({diagonal, row[j], row[j - 1]});
      diagonal = row[j];
      row[j] = std::max(reach, (a[i] - b[j - 1]).squaredNorm());
    }
  }
  return std::sqrt(row.back());
}

double DynamicTimeWarping_m(const Points& a, const Points& b) {
  struct Cost {
    double total_m = kInfinity;
    int steps = 0;
    bool operator<(const Cost& other) const { return total_m < other.total_m; }
  };
  std::vector<Cost> row(b.size() + 1);
  for (size_t i = 0; i < a.size(); ++i) {
    Cost diagonal = i == 0 ? Cost{0.0, 0} : Cost{};
    row[0] = Cost{};
    for (size_t j = 1; j <= b.size(); ++j) {
      const Cost best = std::min({diagonal, row[j], row[j - 1]});
      diagonal = row[j];
      row[j] = {best.total_m + (a[i] - b[j - 1]).norm(), best.steps + 1};
    }
  }
  return row.back().total_m / row.back().steps;
}

double EqualTime_m(const trajectory::Trajectory& a, const trajectory::Trajectory& b) {
  const double end_s = std::min(a.Duration_s(), b.Duration_s());
  double largest_m = 0.0;
  // The distance is convex between merged time stamps, so they alone need a look.
  const auto visit = [&](const trajectory::Trajectory& stamps) {
    size_t row_a = 0, row_b = 0;
    for (const trajectory::StampedPose& pose : stamps.poses) {
      const double since_start_s = std::min(pose.t_s - stamps.poses.front().t_s, end_s);
      const Eigen::Vector2d difference_m =
          PositionAt(a, since_start_s, row_a) - PositionAt(b, since_start_s, row_b);
      largest_m = std::max(largest_m, difference_m.norm());
    }
  };
  visit(a);
  visit(b);
  return largest_m;
}

}  // namespace rift::gap
