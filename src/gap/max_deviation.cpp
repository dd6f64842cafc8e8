#include "max_deviation.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace rift::gap {
namespace {

/// Calls visit(u_begin, u_end, i, j) for each interval between neighbouring breakpoints of either
/// path: in it `sim` stands on its edge i and `real` on its edge j.
template <int N, class Visit>
void ForEachInterval(const ArcPathIn<N>& sim, const ArcPathIn<N>& real, Visit&& visit) {
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
template <int N>
class PathError {
 public:
  PathError(const ArcPathIn<N>& sim, const ArcPathIn<N>& real, const PoseIn<N>& real_from_sim = {})
      : sim_(sim), real_(real), motion_(real_from_sim) {}

  /// Its length for u on edge i of the sim and edge j of the real path.
  auto OnEdges(size_t i, size_t j) const {
    return [sim = Segment(sim_, i, motion_), real = Segment(real_, j)](double u) {
      return (real.At(u) - sim.At(u)).norm();
    };
  }

 private:
  using PointMotion = typename MotionIn<N>::OfPoints;

  /// One edge of a path as a function of u; an edge too short to move u stands at its start.
  struct Segment {
    Segment(const ArcPathIn<N>& path, size_t i)
        : Segment(path, i, path.Vertex(i), path.Vertex(i + 1)) {}
    Segment(const ArcPathIn<N>& path, size_t i, const PointMotion& motion)
        : Segment(path, i, motion * path.Vertex(i), motion * path.Vertex(i + 1)) {}
    Segment(const ArcPathIn<N>& path, size_t i, const Point<N>& from, const Point<N>& to)
        : u0(path.u[i]), p0(from) {
      const double span = path.u[i + 1] - path.u[i];
      if (span > 0.0) slope = (to - from) / span;
    }
    Point<N> At(double u) const { return p0 + slope * (u - u0); }

    double u0;
    Point<N> p0;
    Point<N> slope = Point<N>::Zero();
  };

  const ArcPathIn<N>& sim_;
  const ArcPathIn<N>& real_;
  PointMotion motion_;
};

}  // namespace

/// The published numbers leave out int(0.1 * 2000) samples; the margin keeps a product such as
/// 0.29 * 100 = 28.999999999999996 from losing one.
int FirstSample(const GapOptions& options) {
  return std::min(static_cast<int>(options.skip_start * options.samples + 1e-9),
                  options.samples - 1);
}

double SampleU(int k, const GapOptions& options) {
  return static_cast<double>(k) / (options.samples - 1);
}

// The error is convex in u within an interval, so the first and the last sample in it are enough.
template <int N>
Peak SampledPeak(const ArcPathIn<N>& sim, const ArcPathIn<N>& real, const GapOptions& options,
                 const PoseIn<N>& real_from_sim) {
  const PathError<N> error(sim, real, real_from_sim);
  Peak peak;
  int next = FirstSample(options);
  ForEachInterval(sim, real, [&](double, double end, size_t i, size_t j) {
    const int last =
        std::min(static_cast<int>(end * (options.samples - 1) + 1e-9), options.samples - 1);
    if (last < next) return;  // most intervals of a long log hold no sample
    const auto error_at = error.OnEdges(i, j);
    for (const int k : {next, last}) {
      const double error_m = error_at(SampleU(k, options));
      if (error_m > peak.error_m) peak = {error_m, SampleU(k, options)};
    }
    next = last + 1;
  });
  assert(peak.error_m >= 0.0);
  return peak;
}

template <int N>
Peak ExactPeak(const ArcPathIn<N>& sim, const ArcPathIn<N>& real, const GapOptions& options) {
  const PathError<N> error(sim, real);
  Peak peak;
  const double first_u = SampleU(FirstSample(options), options);
  const auto look_at = [&peak](double u, double error_m) {
    if (error_m > peak.error_m) peak = {error_m, u};
  };
  ForEachInterval(sim, real, [&](double begin, double end, size_t i, size_t j) {
    if (end < first_u) return;
    const auto error_at = error.OnEdges(i, j);
    // The other begins are ends, since the error is continuous.
    if (begin <= first_u) look_at(first_u, error_at(first_u));
    look_at(end, error_at(end));
  });
  assert(peak.error_m >= 0.0);
  return peak;
}

template Peak SampledPeak<2>(const ArcPathIn<2>&, const ArcPathIn<2>&, const GapOptions&,
                             const PoseIn<2>&);
template Peak ExactPeak<2>(const ArcPathIn<2>&, const ArcPathIn<2>&, const GapOptions&);
template Peak SampledPeak<3>(const ArcPathIn<3>&, const ArcPathIn<3>&, const GapOptions&,
                             const PoseIn<3>&);
template Peak ExactPeak<3>(const ArcPathIn<3>&, const ArcPathIn<3>&, const GapOptions&);

}  // namespace rift::gap
