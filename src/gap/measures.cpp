#include "measures.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace rift::gap {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// The edges of a polyline, a column for each number, so that the loop over them vectorises.
struct Edges {
  explicit Edges(const Points& points) {
    for (size_t i = 1; i < points.size(); ++i) {
      const Eigen::Vector2d along = points[i] - points[i - 1];
      const double squared_length = along.squaredNorm();
      x.push_back(points[i - 1].x());
      y.push_back(points[i - 1].y());
      along_x.push_back(along.x());
      along_y.push_back(along.y());
      inverse_squared_length.push_back(squared_length > 0.0 ? 1.0 / squared_length : 0.0);
    }
  }

  double SquaredDistanceTo(const Eigen::Vector2d& p) const {
    double closest = kInfinity;
    for (size_t i = 0; i < x.size(); ++i) {
      const double to_x = p.x() - x[i], to_y = p.y() - y[i];
      const double share = (to_x * along_x[i] + to_y * along_y[i]) * inverse_squared_length[i];
      const double on_edge = std::max(0.0, std::min(1.0, share));
      const double off_x = to_x - on_edge * along_x[i], off_y = to_y - on_edge * along_y[i];
      closest = std::min(closest, off_x * off_x + off_y * off_y);
    }
    return closest;
  }

  std::vector<double> x, y, along_x, along_y, inverse_squared_length;
};

double DirectedHausdorff_m(const Points& from, const Points& to) {
  const Edges edges(to);
  double largest = 0.0;
  for (const Eigen::Vector2d& p : from) largest = std::max(largest, edges.SquaredDistanceTo(p));
  return std::sqrt(largest);
}

/// Squared distances from one point to each of a row of points, all at once.
class SquaredDistances {
 public:
  explicit SquaredDistances(const Points& points) : x_(points.size()), y_(points.size()) {
    for (size_t i = 0; i < points.size(); ++i) {
      x_[i] = points[i].x();
      y_[i] = points[i].y();
    }
  }
  auto From(const Eigen::Vector2d& p) const {
    return (p.x() - x_).square() + (p.y() - y_).square();
  }

 private:
  Eigen::ArrayXd x_, y_;
};

double Duration_s(const ArcPath& path) { return path.t_s.back() - path.t_s.front(); }

Eigen::Vector2d PositionAt(const ArcPath& path, double since_start_s, size_t& i) {
  const double t_s = path.t_s.front() + since_start_s;
  while (i + 2 < path.Size() && path.t_s[i + 1] <= t_s) ++i;
  const double span_s = path.t_s[i + 1] - path.t_s[i];
  const double share = span_s > 0.0 ? std::clamp((t_s - path.t_s[i]) / span_s, 0.0, 1.0) : 0.0;
  return path.Vertex(i) + share * (path.Vertex(i + 1) - path.Vertex(i));
}

}  // namespace

double Hausdorff_m(const Points& a, const Points& b) {
  return std::max(DirectedHausdorff_m(a, b), DirectedHausdorff_m(b, a));
}

double DiscreteFrechet_m(const Points& a, const Points& b) {
  // Squared distances: the order of maxima and minima is the same, one root at the end.
  const SquaredDistances to_b(b);
  Eigen::ArrayXd distance(b.size());
  std::vector<double> row(b.size() + 1, kInfinity);
  for (size_t i = 0; i < a.size(); ++i) {
    distance = to_b.From(a[i]);
    double diagonal = i == 0 ? 0.0 : kInfinity;
    row[0] = kInfinity;
    for (size_t j = 1; j <= b.size(); ++j) {
      const double reach = std::min(std::min(diagonal, row[j]), row[j - 1]);
      diagonal = row[j];
      row[j] = std::max(reach, distance[j - 1]);
    }
  }
  return std::sqrt(row.back());
}

double DynamicTimeWarping_m(const Points& a, const Points& b) {
  struct Cost {
    double total_m = kInfinity;
    int steps = 0;
  };
  // Two selections, not one branch: which way the walk goes is as good as random.
  const auto cheaper = [](const Cost& one, const Cost& other) {
    return Cost{std::min(one.total_m, other.total_m),
                other.total_m < one.total_m ? other.steps : one.steps};
  };
  const SquaredDistances to_b(b);
  Eigen::ArrayXd distance_m(b.size());
  std::vector<Cost> row(b.size() + 1);
  for (size_t i = 0; i < a.size(); ++i) {
    distance_m = to_b.From(a[i]).sqrt();
    Cost diagonal = i == 0 ? Cost{0.0, 0} : Cost{};
    row[0] = Cost{};
    for (size_t j = 1; j <= b.size(); ++j) {
      const Cost best = cheaper(cheaper(diagonal, row[j]), row[j - 1]);
      diagonal = row[j];
      row[j] = {best.total_m + distance_m[j - 1], best.steps + 1};
    }
  }
  return row.back().total_m / row.back().steps;
}

double EqualTime_m(const ArcPath& a, const ArcPath& b) {
  assert(a.t_s.size() == a.Size() && b.t_s.size() == b.Size());
  const double end_s = std::min(Duration_s(a), Duration_s(b));
  double largest_m = 0.0;
  // The distance is convex between merged time stamps, so they alone need a look.
  const auto visit = [&](const ArcPath& stamps) {
    size_t i = 0, j = 0;
    for (const double t_s : stamps.t_s) {
      const double since_start_s = std::min(t_s - stamps.t_s.front(), end_s);
      const Eigen::Vector2d difference_m =
          PositionAt(a, since_start_s, i) - PositionAt(b, since_start_s, j);
      largest_m = std::max(largest_m, difference_m.norm());
    }
  };
  visit(a);
  visit(b);
  return largest_m;
}

}  // namespace rift::gap
