#include "other_distances.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace rift::gap {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

template <int N>
double DirectedHausdorff_m(const PointsIn<N>& from, const PointsIn<N>& to) {
  double largest_m2 = 0.0;
  for (const Point<N>& p : from) {
    double closest_m2 = kInfinity;
    for (size_t i = 0; i + 1 < to.size(); ++i) {
      const Point<N> along = to[i + 1] - to[i], to_p = p - to[i];
      const double length_m2 = along.squaredNorm();
      const double inverse = length_m2 > 0.0 ? 1.0 / length_m2 : 0.0;
      const double on_edge = std::clamp(to_p.dot(along) * inverse, 0.0, 1.0);
      closest_m2 = std::min(closest_m2, (to_p - on_edge * along).squaredNorm());
    }
    largest_m2 = std::max(largest_m2, closest_m2);
  }
  return std::sqrt(largest_m2);
}

template <int N>
double SinceStart_s(const ArcPathIn<N>& path, size_t i) {
  return path.poses[i].t_s - path.poses.front().t_s;
}

/// On edge i of the path.
template <int N>
Point<N> PositionAt(const ArcPathIn<N>& path, double since_start_s, size_t i) {
  const double span_s = path.poses[i + 1].t_s - path.poses[i].t_s;
  const double share = span_s > 0.0 ? (since_start_s - SinceStart_s(path, i)) / span_s : 0.0;
  return path.Vertex(i) + share * (path.Vertex(i + 1) - path.Vertex(i));
}

}  // namespace

template <int N>
double HausdorffIn_m(const PointsIn<N>& a, const PointsIn<N>& b) {
  return std::max(DirectedHausdorff_m<N>(a, b), DirectedHausdorff_m<N>(b, a));
}

template <int N>
double DiscreteFrechetIn_m(const PointsIn<N>& a, const PointsIn<N>& b) {
  // leash[j + 1]: squared, from the start to the points i of a and j of b.
  std::vector<double> leash(b.size() + 1, kInfinity);
  double corner = 0.0;  // of the cell before in both rows
  for (const Point<N>& point : a) {
    for (size_t j = 0; j < b.size(); ++j) {
      const double least = std::min({corner, leash[j + 1], leash[j]});
      corner = leash[j + 1];
      leash[j + 1] = std::max(least, (point - b[j]).squaredNorm());
    }
    corner = kInfinity;
  }
  return std::sqrt(leash.back());
}

template <int N>
double DynamicTimeWarpingIn_m(const PointsIn<N>& a, const PointsIn<N>& b) {
  struct Walk {
    double total_m = kInfinity;
    double steps = 0.0;
  };
  // walks[j + 1]: the cheapest from the start to the points i of a and j of b.
  std::vector<Walk> walks(b.size() + 1);
  Walk corner{0.0, 0.0};
  for (const Point<N>& point : a) {
    for (size_t j = 0; j < b.size(); ++j) {
      Walk least = corner;
      if (walks[j + 1].total_m < least.total_m) least = walks[j + 1];
      if (walks[j].total_m < least.total_m) least = walks[j];
      corner = walks[j + 1];
      walks[j + 1] = {least.total_m + (point - b[j]).norm(), least.steps + 1.0};
    }
    corner = {};
  }
  return walks.back().total_m / walks.back().steps;
}

template <int N>
double EqualTime_m(const ArcPathIn<N>& a, const ArcPathIn<N>& b) {
  double largest_m = (a.Vertex(0) - b.Vertex(0)).norm();
  // The distance is convex between merged time stamps, so they alone need a look.
  size_t i = 0, j = 0;
  while (i + 1 < a.Size() && j + 1 < b.Size()) {
    const double a_s = SinceStart_s(a, i + 1), b_s = SinceStart_s(b, j + 1);
    const double now_s = std::min(a_s, b_s);
    const Point<N> difference_m = PositionAt(a, now_s, i) - PositionAt(b, now_s, j);
    largest_m = std::max(largest_m, difference_m.norm());
    // Sums, not branches: which of the two paths goes on is as good as random.
    i += a_s <= now_s;
    j += b_s <= now_s;
  }
  return largest_m;
}

template double HausdorffIn_m<2>(const PointsIn<2>&, const PointsIn<2>&);
template double DiscreteFrechetIn_m<2>(const PointsIn<2>&, const PointsIn<2>&);
template double DynamicTimeWarpingIn_m<2>(const PointsIn<2>&, const PointsIn<2>&);
template double EqualTime_m<2>(const ArcPathIn<2>&, const ArcPathIn<2>&);
template double HausdorffIn_m<3>(const PointsIn<3>&, const PointsIn<3>&);
template double DiscreteFrechetIn_m<3>(const PointsIn<3>&, const PointsIn<3>&);
template double DynamicTimeWarpingIn_m<3>(const PointsIn<3>&, const PointsIn<3>&);
template double EqualTime_m<3>(const ArcPathIn<3>&, const ArcPathIn<3>&);

}  // namespace rift::gap
