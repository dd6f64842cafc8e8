#include "rift/gap/comparison.hpp"
#include "other_distances.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <stdexcept>
#include <string>
#include <vector>

#include "arc_path.hpp"
#include "max_deviation.hpp"
#include "path_shape.hpp"
#include "rift/geometry/pose2.hpp"
#include "rift/statistics/descriptive.hpp"

namespace rift::gap {
namespace {

/// DTW and Frechet cost points squared; 160 stand 4 mm apart on the paper's path.
constexpr int kEvenPoints = 160;

/// So do Hausdorff and Frechet: of a longer path not every vertex is looked at.
constexpr int kMostVertices = 500;

template <int N>
struct Paths {
  ArcPathIn<N> sim;
  ArcPathIn<N> real;
};

/// Both paths as they are to be compared, after trimming and aligning.
template <int N>
Paths<N> Prepare(const trajectory::Trajectory& sim, const trajectory::Trajectory& real,
                 const GapOptions& options) {
  Paths<N> paths{MakeArcPathIn<N>(sim, options), MakeArcPathIn<N>(real, options)};
  if (options.align != Align::kNone) {
    Transform(paths.sim, AligningMotion(paths.sim, paths.real, options.align, options.samples));
  }
  return paths;
}

template <int N>
double YawAt(const ArcPathIn<N>& path, double u, size_t& i) {
  const double share = ShareAt(path, u, i);
  const double yaw_rad = path.poses[i].yaw_rad;
  const double step_rad = geometry::WrapToPi(path.poses[i + 1].yaw_rad - yaw_rad);
  return yaw_rad + share * step_rad;
}

/// The points of both paths at the samples, those left out at the start included.
template <int N>
struct SampledPaths {
  SampledPaths(const Paths<N>& paths, const GapOptions& options)
      : sim_m(Resample(paths.sim, options.samples)),
        real_m(Resample(paths.real, options.samples)) {}

  PointsIn<N> sim_m;
  PointsIn<N> real_m;
};

template <int N>
std::vector<double> Errors_m(const SampledPaths<N>& samples, const GapOptions& options) {
  std::vector<double> errors_m;
  errors_m.reserve(samples.sim_m.size());
  for (size_t k = FirstSample(options); k < samples.sim_m.size(); ++k) {
    errors_m.push_back((samples.real_m[k] - samples.sim_m[k]).norm());
  }
  return errors_m;
}

/// NaN where one of the yaws is not known.
template <int N>
std::vector<double> YawErrors_rad(const Paths<N>& paths, const GapOptions& options) {
  std::vector<double> errors_rad;
  errors_rad.reserve(options.samples);
  size_t i = 0, j = 0;
  for (int k = FirstSample(options); k < options.samples; ++k) {
    const double u = SampleU(k, options);
    errors_rad.push_back(geometry::WrapToPi(YawAt(paths.sim, u, i) - YawAt(paths.real, u, j)));
  }
  return errors_rad;
}

/// Mean, RMS, median and 95 % of the errors at the samples.
void SummariseErrors(std::vector<double> errors_m, Comparison& result) {
  result.mean_error_m = statistics::Mean(errors_m);
  double squares = 0.0;
  for (const double error_m : errors_m) squares += error_m * error_m;
  result.rms_error_m = std::sqrt(squares / static_cast<double>(errors_m.size()));
  result.median_error_m = statistics::Median(errors_m);
  result.p95_error_m = statistics::Quantile(std::move(errors_m), 0.95);
}

/// Mean and maximum of the sizes of those that are not NaN; nothing without any.
void SummariseYawErrors(std::vector<double> errors_rad, Comparison& result) {
  std::erase_if(errors_rad, [](double error_rad) { return std::isnan(error_rad); });
  if (errors_rad.empty()) return;
  for (double& error_rad : errors_rad) error_rad = std::abs(error_rad);
  result.mean_yaw_error_rad = statistics::Mean(errors_rad);
  result.max_yaw_error_rad = *std::max_element(errors_rad.begin(), errors_rad.end());
}

template <int N>
void MeasureErrors(const Paths<N>& paths, const GapOptions& options, Comparison& result) {
  const SampledPaths<N> samples(paths, options);
  SummariseErrors(Errors_m(samples, options), result);
  SummariseYawErrors(YawErrors_rad(paths, options), result);
}

/// The gap as it is, its supremum, and what is left of it after two motions of the sim path.
template <int N>
void MeasureGaps(const Paths<N>& paths, const GapOptions& options, Comparison& result) {
  const auto& [sim, real] = paths;
  const Peak gap = SampledPeak<N>(sim, real, options), exact = ExactPeak(sim, real, options);
  result.gap_m = gap.error_m;
  result.gap_u = gap.u;
  result.exact_gap_m = exact.error_m;
  result.exact_gap_u = exact.u;
  result.start_aligned_gap_m = SampledPeak<N>(sim, real, options, StartMotion(sim, real)).error_m;
  const PoseIn<N> real_from_sim = BestRigidMotion(sim, real, options.samples);
  result.shape_gap_m = SampledPeak<N>(sim, real, options, real_from_sim).error_m;
  if constexpr (N == 2)
    result.real_from_sim = real_from_sim;
  else
    result.real_from_sim = {kNotComputed, kNotComputed, kNotComputed};
}

template <int N>
void MeasureEnds(const Paths<N>& paths, Comparison& result) {
  result.sim_length_m = paths.sim.length_m;
  result.real_length_m = paths.real.length_m;
  result.length_ratio = paths.sim.length_m / paths.real.length_m;
  result.start_offset_m = (paths.sim.Vertex(0) - paths.real.Vertex(0)).norm();
  result.end_error_m =
      (paths.sim.Vertex(paths.sim.Size() - 1) - paths.real.Vertex(paths.real.Size() - 1)).norm();
}

/// Of the vertices; of a path with too many of them as many evenly spaced ones.
template <int N>
std::vector<double> VertexShares(const ArcPathIn<N>& path) {
  return path.Size() > kMostVertices ? EvenShares(kMostVertices) : path.u;
}

/// Of two that rise, what is in both once.
std::vector<double> Union(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<double> both;
  std::set_union(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(both));
  return both;
}

// The points of Frechet are those of Hausdorff and more, and stand in pairs at equal u: it is below
// Hausdorff by rounding at most, and never above the exact gap of the whole paths.
template <int N>
void MeasureShape(const Paths<N>& paths, Comparison& result) {
  const auto& [sim, real] = paths;
  const std::vector<double> of_sim = VertexShares(sim), of_real = VertexShares(real);
  result.hausdorff_m = HausdorffIn_m<N>(PointsAt(sim, of_sim), PointsAt(real, of_real));
  std::vector<double> shares = Union(of_sim, of_real);
  if (shares.size() < kEvenPoints) shares = Union(shares, EvenShares(kEvenPoints));
  result.frechet_m = std::max(
      result.hausdorff_m, DiscreteFrechetIn_m<N>(PointsAt(sim, shares), PointsAt(real, shares)));
  result.dtw_m = DynamicTimeWarpingIn_m<N>(Resample(sim, kEvenPoints), Resample(real, kEvenPoints));
}

template <int N>
double GapIn(const trajectory::Trajectory& sim, const trajectory::Trajectory& real,
             const GapOptions& options) {
  const Paths<N> paths = Prepare<N>(sim, real, options);
  return SampledPeak<N>(paths.sim, paths.real, options).error_m;
}

template <int N>
void AddPoints(const PointsIn<N>& points_m, size_t first, std::vector<Eigen::Vector2d>& plane_m,
               std::vector<double>& z_m) {
  for (size_t k = first; k < points_m.size(); ++k) {
    plane_m.emplace_back(points_m[k].template head<2>());
    if constexpr (N == 3) z_m.push_back(points_m[k].z());
  }
}

template <int N>
ErrorProfile ProfileIn(const trajectory::Trajectory& sim, const trajectory::Trajectory& real,
                       const GapOptions& options) {
  const Paths<N> paths = Prepare<N>(sim, real, options);
  const SampledPaths<N> samples(paths, options);
  const int first = FirstSample(options);
  ErrorProfile profile;
  for (int k = first; k < options.samples; ++k) profile.u.push_back(SampleU(k, options));
  profile.error_m = Errors_m(samples, options);
  profile.yaw_error_rad = YawErrors_rad(paths, options);
  AddPoints<N>(samples.sim_m, first, profile.sim_m, profile.sim_z_m);
  AddPoints<N>(samples.real_m, first, profile.real_m, profile.real_z_m);
  return profile;
}

template <int N>
std::vector<double> TimesIn_s(const trajectory::Trajectory& trajectory, const GapOptions& options) {
  const ArcPathIn<N> path = MakeArcPathIn<N>(trajectory, options);
  std::vector<double> times_s;
  size_t i = 0;
  for (int k = FirstSample(options); k < options.samples; ++k) {
    const double share = ShareAt(path, SampleU(k, options), i), from_s = path.poses[i].t_s;
    times_s.push_back(from_s + share * (path.poses[i + 1].t_s - from_s) - path.poses[0].t_s);
  }
  return times_s;
}

template <int N>
Comparison CompareIn(const trajectory::Trajectory& sim, const trajectory::Trajectory& real,
                     const GapOptions& options) {
  const Paths<N> paths = Prepare<N>(sim, real, options);
  Comparison result;
  MeasureGaps(paths, options, result);
  MeasureErrors(paths, options, result);
  MeasureEnds(paths, result);
  MeasureShape(paths, result);
  result.equal_time_m = EqualTime_m(paths.sim, paths.real);
  // Of the whole logs, whether the paths were trimmed or not.
  result.sim_standstill_share = StandingShare<N>(sim.poses, options.standstill_radius_m);
  result.real_standstill_share = StandingShare<N>(real.poses, options.standstill_radius_m);
  return result;
}

}  // namespace

void GapOptions::Check() const {
  if (align == Align::kSe2 && IsInSpace()) {
    throw std::invalid_argument(
        "align is se2, a motion in the plane, and dimension is xyz: use se3");
  }
  if (align == Align::kSe3 && !IsInSpace()) {
    throw std::invalid_argument(
        "align is se3, a motion in space, and dimension is xy: use se2, or dimension xyz");
  }
}

double Gap(const trajectory::Trajectory& sim, const trajectory::Trajectory& real,
           const GapOptions& options) {
  options.Check();
  return options.IsInSpace() ? GapIn<3>(sim, real, options) : GapIn<2>(sim, real, options);
}

ErrorProfile ProfileAlong(const trajectory::Trajectory& sim, const trajectory::Trajectory& real,
                          const GapOptions& options) {
  options.Check();
  return options.IsInSpace() ? ProfileIn<3>(sim, real, options) : ProfileIn<2>(sim, real, options);
}

std::vector<double> TimesAlong_s(const trajectory::Trajectory& path, const GapOptions& options) {
  options.Check();
  return options.IsInSpace() ? TimesIn_s<3>(path, options) : TimesIn_s<2>(path, options);
}

double MovingLength_m(const trajectory::Trajectory& path, const GapOptions& options) {
  return options.IsInSpace() ? MovingLength_m<3>(path.poses, options.standstill_radius_m)
                             : MovingLength_m<2>(path.poses, options.standstill_radius_m);
}

Comparison Compare(const trajectory::Trajectory& sim, const trajectory::Trajectory& real,
                   const GapOptions& options) {
  options.Check();
  return options.IsInSpace() ? CompareIn<3>(sim, real, options) : CompareIn<2>(sim, real, options);
}

geometry::Pose3 BestMotionInSpace(const trajectory::Trajectory& sim,
                                  const trajectory::Trajectory& real, const GapOptions& options) {
  const Paths<3> paths = Prepare<3>(sim, real, options);
  return BestRigidMotion<3>(paths.sim, paths.real, options.samples);
}

std::string DefinitionText(const GapOptions& options, double tag_offset_m) {
  std::string text =
      fmt::format("largest distance{} at equal normalised arc length u over {} samples",
                  options.IsInSpace() ? " in x, y and z" : "", options.samples);
  if (options.skip_start > 0.0) {
    text += fmt::format(", the first {:g} % left out", 100.0 * options.skip_start);
  }
  if (options.align == Align::kStart) text += ", first points laid together";
  if (options.align >= Align::kSe2) text += ", best rigid motion removed";
  if (options.trim_standstill) text += ", standstill trimmed";
  if (tag_offset_m != 0.0) text += fmt::format(", real path {:g} m ahead of the tag", tag_offset_m);
  return text;
}

}  // namespace rift::gap
