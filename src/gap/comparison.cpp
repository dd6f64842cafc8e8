#include "rift/gap/comparison.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <future>
#include <string>
#include <vector>

#include "alignment.hpp"
#include "arc_path.hpp"
#include "error_summary.hpp"
#include "measures.hpp"
#include "path_error.hpp"
#include "rift/geometry/angle.hpp"
#include "standstill.hpp"

namespace rift::gap {
namespace {

/// Frechet and DTW cost points squared; 160 stand 4 mm apart on the paper's path.
constexpr int kMeasurePoints = 160;

/// Hausdorff costs the product of the rows; up to this many pairs every vertex is looked at.
constexpr size_t kMostHausdorffPairs = 65536;

/// From this many rows on a second thread is worth its start.
constexpr size_t kManyRows = 20'000;

struct Paths {
  ArcPath sim;
  ArcPath real;

  bool AreLong() const { return sim.Size() + real.Size() >= kManyRows; }
};

/// Calls both, at once if told to. What `first` throws comes before what `second` does.
template <class First, class Second>
void CallBoth(bool at_once, First&& first, Second&& second) {
  std::future<void> other;
  if (at_once) other = std::async(std::launch::async, second);
  first();
  at_once ? other.get() : second();
}

/// Both paths as they are to be compared, after trimming and aligning.
Paths Prepare(const trajectory::Trajectory& sim, const trajectory::Trajectory& real,
              const GapOptions& options) {
  Paths paths;
  CallBoth(
      sim.poses.size() + real.poses.size() >= kManyRows,
      [&] { paths.sim = MakeArcPath(sim, options); },
      [&] { paths.real = MakeArcPath(real, options); });
  if (options.align != Align::kNone) {
    Transform(paths.sim, AligningMotion(paths.sim, paths.real, options.align, options.samples));
  }
  return paths;
}

/// The published numbers leave out int(0.1 * 2000) samples; the margin keeps a product such as
/// 0.29 * 100 = 28.999999999999996 from losing one.
int FirstSample(const GapOptions& options) {
  return std::min(static_cast<int>(options.skip_start * options.samples + 1e-9),
                  options.samples - 1);
}

double SampleU(int k, const GapOptions& options) {
  return static_cast<double>(k) / (options.samples - 1);
}

/// Equation (3.1): the largest error over the samples, from two of them in each interval, with the
/// sim path moved by each of the motions.
template <size_t kMotions>
std::array<Peak, kMotions> SampledPeaks(const Paths& paths,
                                        const std::array<geometry::Pose2, kMotions>& motions,
                                        const GapOptions& options) {
  std::vector<PathError> errors;
  for (const geometry::Pose2& motion : motions) errors.emplace_back(paths.sim, paths.real, motion);
  std::array<Peak, kMotions> peaks;
  int next = FirstSample(options);
  ForEachInterval(paths.sim, paths.real, [&](double, double end, size_t i, size_t j) {
    const int last =
        std::min(static_cast<int>(end * (options.samples - 1) + 1e-9), options.samples - 1);
    if (last < next) return;  // most intervals of a long log hold no sample
    for (size_t m = 0; m < kMotions; ++m) {
      const auto error_at = errors[m].OnEdges(i, j);
      for (const int k : {next, last}) {
        const double error_m = error_at(SampleU(k, options));
        if (error_m > peaks[m].error_m) peaks[m] = {error_m, SampleU(k, options)};
      }
    }
    next = last + 1;
  });
  assert(peaks[0].error_m >= 0.0);
  return peaks;
}

/// The supremum over the polylines from the first sample on.
Peak ExactPeak(const Paths& paths, const GapOptions& options) {
  const PathError error(paths.sim, paths.real);
  Peak peak;
  const double first_u = SampleU(FirstSample(options), options);
  const auto look_at = [&peak](double u, double error_m) {
    if (error_m > peak.error_m) peak = {error_m, u};
  };
  ForEachInterval(paths.sim, paths.real, [&](double begin, double end, size_t i, size_t j) {
    if (end < first_u) return;
    const auto error_at = error.OnEdges(i, j);
    // The other begins are ends, since the error is continuous.
    if (begin <= first_u) look_at(first_u, error_at(first_u));
    look_at(end, error_at(end));
  });
  assert(peak.error_m >= 0.0);
  return peak;
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

void MeasureErrors(const Paths& paths, const GapOptions& options, Comparison& result) {
  const SampledPaths samples(paths, options);
  SummariseErrors(Errors_m(samples, options), result);
  SummariseYawErrors(YawErrors_rad(paths, options), result);
  result.real_from_sim = BestRigidMotion(samples.sim_m, samples.real_m);
  const auto [as_it_is, start_aligned, shape] = SampledPeaks<3>(
      paths, {geometry::Pose2{}, StartMotion(paths.sim, paths.real), result.real_from_sim},
      options);
  result.gap_m = as_it_is.error_m;
  result.gap_u = as_it_is.u;
  result.start_aligned_gap_m = start_aligned.error_m;
  result.shape_gap_m = shape.error_m;
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
  return SampledPeaks<1>(paths, {geometry::Pose2{}}, options)[0].error_m;
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
  // Each half takes about as long as the other.
  CallBoth(
      paths.AreLong(), [&] { MeasureErrors(paths, options, result); },
      [&] {
        const Peak exact = ExactPeak(paths, options);
        result.exact_gap_m = exact.error_m;
        result.exact_gap_u = exact.u;
        MeasureEnds(paths, result);
        MeasureShape(paths, result);
        result.equal_time_m = EqualTime_m(paths.sim, paths.real);
        result.sim_standstill_share = StandstillShare(sim, paths.sim, options);
        result.real_standstill_share = StandstillShare(real, paths.real, options);
      });
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
