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

/// Calls visit(u_begin, u_end, i, j) for each interval between neighbouring breakpoints of either
/// path: in it `sim` stands on its edge i and `real` on its edge j.
template <class Visit>
void ForEachInterval(const ArcPath& sim, const ArcPath& real, Visit&& visit) {
  const size_t sim_last = sim.Size() - 2, real_last = real.Size() - 2;
  size_t i = 0, j = 0;
  double begin = 0.0;
  while (true) {
    const double end = std::min(sim.u[i + 1], real.u[j + 1]);
    visit(begin, end, i, j);
    begin = end;
    const bool sim_ends = sim.u[i + 1] <= end;
    if (sim_ends && i == sim_last) return;
    // Sums, not branches: which of the two paths goes on is as good as random.
    i += sim_ends;
    j += (real.u[j + 1] <= end) & (j < real_last);
  }
}

/// The error vector real - sim as a function of u, the sim path moved first by `real_from_sim`.
/// In each interval it is affine in u, so its length is convex there: the largest value over any
/// set of u within the interval stands at the first or the last of them.
class PathError {
 public:
  PathError(const ArcPath& sim, const ArcPath& real, const geometry::Pose2& real_from_sim = {})
      : sim_(sim), real_(real), motion_(real_from_sim) {}

  /// Its length for u on edge i of the sim and edge j of the real path.
  auto OnEdges(size_t i, size_t j) const {
    return [sim = Segment(sim_, i, motion_), real = Segment(real_, j)](double u) {
      return (real.At(u) - sim.At(u)).norm();
    };
  }

 private:
  /// One edge of a path as a function of u; an edge too short to move u stands at its start.
  struct Segment {
    Segment(const ArcPath& path, size_t i) : Segment(path, i, path.Vertex(i), path.Vertex(i + 1)) {}
    Segment(const ArcPath& path, size_t i, const geometry::PointMotion& motion)
        : Segment(path, i, motion * path.Vertex(i), motion * path.Vertex(i + 1)) {}
    Segment(const ArcPath& path, size_t i, const Eigen::Vector2d& from, const Eigen::Vector2d& to)
        : u0(path.u[i]), p0(from) {
      const double span = path.u[i + 1] - path.u[i];
      if (span > 0.0) slope = (to - from) / span;
    }
    Eigen::Vector2d At(double u) const { return p0 + slope * (u - u0); }

    double u0;
    Eigen::Vector2d p0;
    Eigen::Vector2d slope = Eigen::Vector2d::Zero();
  };

  const ArcPath& sim_;
  const ArcPath& real_;
  geometry::PointMotion motion_;
};

}  // namespace rift::gap
