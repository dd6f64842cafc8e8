#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "arc_path.hpp"

namespace rift::gap {

/// A value along the path and where it stands.
struct Peak {
  double error_m = -1.0;
  double u = 0.0;
};

/// The error vector real - sim as a function of u. Between two neighbouring breakpoints of either
/// path it is affine in u, so its length is convex there: the largest value over any set of u
/// within such an interval stands at the first or the last of them.
class PathError {
 public:
  PathError(const ArcPath& sim, const ArcPath& real) : sim_(sim), real_(real) {}

  /// Calls visit(u_begin, u_end, error_at) for each interval between merged breakpoints, where
  /// error_at(u) is the error for u within it.
  template <class Visit>
  void ForEachInterval(Visit&& visit) const {
    size_t i = 0, j = 0;
    double begin = 0.0;
    while (true) {
      const double end = std::min(sim_.u[i + 1], real_.u[j + 1]);
      const Segment sim(sim_, i), real(real_, j);
      const auto error_at = [&](double u) {
        return std::sqrt(Square(real.X(u) - sim.X(u)) + Square(real.Y(u) - sim.Y(u)));
      };
      visit(begin, end, error_at);
      begin = end;
      if (real_.u[j + 1] <= end && j + 2 < real_.Size()) ++j;
      if (sim_.u[i + 1] > end) continue;
      if (i + 2 == sim_.Size()) return;
      ++i;
    }
  }

 private:
  /// One edge of a path as a function of u; an edge too short to move u stands at its start.
  struct Segment {
    Segment(const ArcPath& path, size_t i) : u0(path.u[i]), x0(path.x_m[i]), y0(path.y_m[i]) {
      const double span = path.u[i + 1] - path.u[i];
      if (span > 0.0) {
        slope_x = (path.x_m[i + 1] - x0) / span;
        slope_y = (path.y_m[i + 1] - y0) / span;
      }
    }
    double X(double u) const { return x0 + slope_x * (u - u0); }
    double Y(double u) const { return y0 + slope_y * (u - u0); }

    double u0, x0, y0;
    double slope_x = 0.0, slope_y = 0.0;
  };

  static double Square(double value) { return value * value; }

  const ArcPath& sim_;
  const ArcPath& real_;
};

}  // namespace rift::gap
