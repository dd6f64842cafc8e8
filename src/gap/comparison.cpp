#include "rift/gap/comparison.hpp"
#include "other_distances.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <vector>

#include "arc_path.hpp"
#include "max_deviation.hpp"
#include "path_shape.hpp"
#include "rift/geometry/pose2.hpp"
#include "rift/statistics/descriptive.hpp"

namespace rift::gap {
namespace {

/// Frechet and DTW cost points squared; 160 stand 4 mm apart on the paper's path.
constexpr int kMeasurePoints = 160;

/// Hausdorff costs the product of the rows; up to this many pairs every vertex is looked at.
constexpr size_t kMostHausdorffPairs = 65536;

struct Paths {
  ArcPath sim;
  ArcPath real;
};

/// Both paths as they are to be compared, after trimming and aligning.
Paths Prepare(const trajectory::Trajectory& sim, const trajectory::Trajectory& real,
              const GapOptions& options) {
  Paths paths{MakeArcPath(sim, options), MakeArcPath(real, options)};
  if (options.align != Align::kNone) {
    Transform(paths.sim, AligningMotion(paths.sim, paths.real, options.align, options.samples));
  }
  return paths;
}

double YawAt(const ArcPath& path, double u, size_t& i) {
  while (i + 2 < path.Size() && path.u[i + 1] <= u) ++i;
  const double span = path.u[i + 1] - path.u[i];
  const double share = span > 0.0 ? (u - path.u[i]) / span : 0.0;
  const double yaw_rad = path.poses[i].yaw_rad;
  const double step_rad = geometry::WrapToPi(path.poses[i + 1].yaw_rad - yaw_rad);
  return yaw_rad + share * step_rad;
}

/// The points of both paths at the samples, those left out at the start included.
struct SampledPaths {
  SampledPaths(const Paths& paths, const GapOptions& options)
      : sim_m(Resample(paths.sim, options.samples)),
        real_m(Resample(paths.real, options.samples)) {}

  Points sim_m;
  Points real_m;
};

std::vector<double> Errors_m(const SampledPaths& samples, const GapOptions& options) {
  std::vector<double> errors_m;
  errors_m.reserve(samples.sim_m.size());
  for (size_t k = FirstSample(options); k < samples.sim_m.size(); ++k) {
    errors_m.push_back((samples.real_m[k] - samples.sim_m[k]).norm());
  }
  return errors_m;
}

/// NaN where one of the yaws is not known.
std::vector<double> YawErrors_rad(const Paths& paths, const GapOptions& options) {
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

void MeasureErrors(const Paths& paths, const GapOptions& options, Comparison& result) {
  const SampledPaths samples(paths, options);
  SummariseErrors(Errors_m(samples, options), result);
  SummariseYawErrors(YawErrors_rad(paths, options), result);
}

/// The gap as it is, its supremum, and what is left of it after two motions of the sim path.
void MeasureGaps(const Paths& paths, const GapOptions& options, Comparison& result) {
  const auto& [sim, real] = paths;
  const Peak gap = SampledPeak(sim, real, options), exact = ExactPeak(sim, real, options);
  result.gap_m = gap.error_m;
  result.gap_u = gap.u;
  result.exact_gap_m = exact.error_m;
  result.exact_gap_u = exact.u;
  result.start_aligned_gap_m = SampledPeak(sim, real, options, StartMotion(sim, real)).error_m;
  result.real_from_sim = BestRigidMotion(sim, real, options.samples);
  result.shape_gap_m = SampledPeak(sim, real, options, result.real_from_sim).error_m;
}

/// Of the whole log, whether the path was trimmed or not.
double StandstillShare(const trajectory::Trajectory& log, const ArcPath& path,
                       const GapOptions& options) {
  const double standing_m = StandingLength_m(log.poses, options.standstill_radius_m);
  return standing_m / (path.length_m + (options.trim_standstill ? standing_m : 0.0));
}

void MeasureEnds(const Paths& paths, Comparison& result) {
  result.sim_length_m = paths.sim.length_m;
  result.real_length_m = paths.real.length_m;
  result.length_ratio = paths.sim.length_m / paths.real.length_m;
  result.start_offset_m = (paths.sim.Vertex(0) - paths.real.Vertex(0)).norm();
  result.end_error_m =
      (paths.sim.Vertex(paths.sim.Size() - 1) - paths.real.Vertex(paths.real.Size() - 1)).norm();
}

Points Vertices(const ArcPath& path) {
  Points points;
  points.reserve(path.Size());
  for (size_t i = 0; i < path.Size(); ++i) points.push_back(path.Vertex(i));
  return points;
}

void MeasureShape(const Paths& paths, Comparison& result) {
  const Points sim_m = Resample(paths.sim, kMeasurePoints);
  const Points real_m = Resample(paths.real, kMeasurePoints);
  const bool all_vertices = paths.sim.Size() * paths.real.Size() <= kMostHausdorffPairs;
  result.hausdorff_m = all_vertices ? Hausdorff_m(Vertices(paths.sim), Vertices(paths.real))
                                    : Hausdorff_m(sim_m, real_m);
  result.frechet_m = DiscreteFrechet_m(sim_m, real_m);
  result.dtw_m = DynamicTimeWarping_m(sim_m, real_m);
}

}  // namespace

double Gap(const trajectory::Trajectory& sim, const trajectory::Trajectory& real,
           const GapOptions& options) {
  const Paths paths = Prepare(sim, real, options);
  return SampledPeak(paths.sim, paths.real, options).error_m;
}

ErrorProfile ProfileAlong(const trajectory::Trajectory& sim, const trajectory::Trajectory& real,
                          const GapOptions& options) {
  const Paths paths = Prepare(sim, real, options);
  const SampledPaths samples(paths, options);
  const int first = FirstSample(options);
  ErrorProfile profile;
  for (int k = first; k < options.samples; ++k) profile.u.push_back(SampleU(k, options));
  profile.error_m = Errors_m(samples, options);
  profile.yaw_error_rad = YawErrors_rad(paths, options);
  profile.sim_m.assign(samples.sim_m.begin() + first, samples.sim_m.end());
  profile.real_m.assign(samples.real_m.begin() + first, samples.real_m.end());
  return profile;
}

Comparison Compare(const trajectory::Trajectory& sim, const trajectory::Trajectory& real,
                   const GapOptions& options) {
  const Paths paths = Prepare(sim, real, options);
  Comparison result;
  MeasureGaps(paths, options, result);
  MeasureErrors(paths, options, result);
  MeasureEnds(paths, result);
  MeasureShape(paths, result);
  result.equal_time_m = EqualTime_m(paths.sim, paths.real);
  result.sim_standstill_share = StandstillShare(sim, paths.sim, options);
  result.real_standstill_share = StandstillShare(real, paths.real, options);
  return result;
}

std::string DefinitionText(const GapOptions& options, double tag_offset_m) {
  std::string text = fmt::format(
      "largest distance at equal normalised arc length u over {} samples", options.samples);
  if (options.skip_start > 0.0) {
    text += fmt::format(", the first {:g} % left out", 100.0 * options.skip_start);
  }
  if (options.align == Align::kStart) text += ", first points laid together";
  if (options.align == Align::kSe2) text += ", best rigid motion removed";
  if (options.trim_standstill) text += ", standstill trimmed";
  if (tag_offset_m != 0.0) text += fmt::format(", real path {:g} m ahead of the tag", tag_offset_m);
  return text;
}

}  // namespace rift::gap
