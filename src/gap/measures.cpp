#include "measures.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace rift::gap {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// The coordinates of a row of points, a column each, for arithmetic on all of them at once.
struct Coordinates {
  explicit Coordinates(const Points& points) : x(points.size()), y(points.size()) {
    for (size_t i = 0; i < points.size(); ++i) {
      x[i] = points[i].x();
      y[i] = points[i].y();
    }
  }
  Eigen::ArrayXd x, y;
};

double DirectedHausdorff_m(const Points& from, const Points& to) {
  const Coordinates vertices(to);
  const Eigen::Index edges = vertices.x.size() - 1;
  const auto x = vertices.x.head(edges), y = vertices.y.head(edges);
  const Eigen::ArrayXd along_x = vertices.x.tail(edges) - x, along_y = vertices.y.tail(edges) - y;
  const Eigen::ArrayXd squared_length = along_x.square() + along_y.square();
  const Eigen::ArrayXd inverse =
      squared_length.unaryExpr([](double square) { return square > 0.0 ? 1.0 / square : 0.0; });
  Eigen::ArrayXd to_x(edges), to_y(edges), on_edge(edges);
  double largest = 0.0;
  for (const Eigen::Vector2d& p : from) {
    to_x = p.x() - x;
    to_y = p.y() - y;
    on_edge = ((to_x * along_x + to_y * along_y) * inverse).min(1.0).max(0.0);
    const double closest =
        ((to_x - on_edge * along_x).square() + (to_y - on_edge * along_y).square()).minCoeff();
    largest = std::max(largest, closest);
  }
  return std::sqrt(largest);
}

/// Squared distances between the points of two rows that a table of both has on one diagonal: its
/// cells do not depend on each other, so that whole diagonals are computed at once.
class DiagonalDistances {
 public:
  DiagonalDistances(const Points& a, const Points& b) : a_(a), b_(Points(b.rbegin(), b.rend())) {}

  /// Calls visit(first, squared_distances) for the diagonals i + j = 0, 1, ..., of which the first
  /// cell has i = first.
  template <class Visit>
  void ForEach(Visit&& visit) const {
    const Eigen::Index rows = a_.x.size(), columns = b_.x.size();
    for (Eigen::Index sum = 0; sum < rows + columns - 1; ++sum) {
      const Eigen::Index first = std::max<Eigen::Index>(0, sum - columns + 1);
      const Eigen::Index size = std::min(rows, sum + 1) - first;
      const Eigen::Index in_b = first + columns - 1 - sum;
      visit(first, (a_.x.segment(first, size) - b_.x.segment(in_b, size)).square() +
                       (a_.y.segment(first, size) - b_.y.segment(in_b, size)).square());
    }
  }

 private:
  Coordinates a_, b_;  ///< b from its last point on
};

/// One number for each cell of the diagonal that is being filled and of the two before it. Cell
/// (i, j) stands at i + 1; what lies outside the table is infinite.
struct Diagonals {
  explicit Diagonals(size_t rows)
      : cells(Eigen::ArrayXd::Constant(rows + 1, kInfinity)), last(cells), before_last(cells) {}

  auto Cells(Eigen::Index first, Eigen::Index size) { return cells.segment(first + 1, size); }
  auto FromAbove(Eigen::Index first, Eigen::Index size) const { return last.segment(first, size); }
  auto FromLeft(Eigen::Index first, Eigen::Index size) const {
    return last.segment(first + 1, size);
  }
  auto FromCorner(Eigen::Index first, Eigen::Index size) const {
    return before_last.segment(first, size);
  }
  void GoOn() {
    before_last[0] = kInfinity;
    before_last.swap(last);
    last.swap(cells);
  }

  Eigen::ArrayXd cells, last, before_last;
};

double SinceStart_s(const ArcPath& path, size_t i) {
  return path.poses[i].t_s - path.poses.front().t_s;
}

/// On edge i of the path.
Eigen::Vector2d PositionAt(const ArcPath& path, double since_start_s, size_t i) {
  const double span_s = path.poses[i + 1].t_s - path.poses[i].t_s;
  const double share = span_s > 0.0 ? (since_start_s - SinceStart_s(path, i)) / span_s : 0.0;
  return path.Vertex(i) + share * (path.Vertex(i + 1) - path.Vertex(i));
}

}  // namespace

double Hausdorff_m(const Points& a, const Points& b) {
  return std::max(DirectedHausdorff_m(a, b), DirectedHausdorff_m(b, a));
}

double DiscreteFrechet_m(const Points& a, const Points& b) {
  // Squared distances: the order of maxima and minima is the same, one root at the end.
  Diagonals leash(a.size());
  leash.before_last[0] = 0.0;
  DiagonalDistances(a, b).ForEach([&](Eigen::Index first, const auto& squared_distances) {
    const Eigen::Index size = squared_distances.size();
    leash.Cells(first, size) = leash.FromCorner(first, size)
                                   .min(leash.FromAbove(first, size))
                                   .min(leash.FromLeft(first, size))
                                   .max(squared_distances);
    leash.GoOn();
  });
  return std::sqrt(leash.last[a.size()]);
}

double DynamicTimeWarping_m(const Points& a, const Points& b) {
  Diagonals total_m(a.size()), steps(a.size());
  total_m.before_last[0] = steps.before_last[0] = 0.0;
  Eigen::ArrayXd distances_m(a.size());
  DiagonalDistances(a, b).ForEach([&](Eigen::Index first, const auto& squared_distances) {
    const Eigen::Index size = squared_distances.size();
    distances_m.head(size) = squared_distances.sqrt();
    for (Eigen::Index k = 0; k < size; ++k) {
      const Eigen::Index i = first + k;
      // Selections, not branches: which way the walk goes is as good as random.
      const bool above = total_m.last[i] < total_m.before_last[i];
      const double two_m = above ? total_m.last[i] : total_m.before_last[i];
      const double two_steps = above ? steps.last[i] : steps.before_last[i];
      const bool left = total_m.last[i + 1] < two_m;
      total_m.cells[i + 1] = (left ? total_m.last[i + 1] : two_m) + distances_m[k];
      steps.cells[i + 1] = (left ? steps.last[i + 1] : two_steps) + 1.0;
    }
    total_m.GoOn();
    steps.GoOn();
  });
  return total_m.last[a.size()] / steps.last[a.size()];
}

double EqualTime_m(const ArcPath& a, const ArcPath& b) {
  double largest_m = (a.Vertex(0) - b.Vertex(0)).norm();
  // The distance is convex between merged time stamps, so they alone need a look.
  size_t i = 0, j = 0;
  while (i + 1 < a.Size() && j + 1 < b.Size()) {
    const double a_s = SinceStart_s(a, i + 1), b_s = SinceStart_s(b, j + 1);
    const double now_s = std::min(a_s, b_s);
    const Eigen::Vector2d difference_m = PositionAt(a, now_s, i) - PositionAt(b, now_s, j);
    largest_m = std::max(largest_m, difference_m.norm());
    // Sums, not branches: which of the two paths goes on is as good as random.
    i += a_s <= now_s;
    j += b_s <= now_s;
  }
  return largest_m;
}

}  // namespace rift::gap
