#pragma once

#include <array>
#include <random>
#include <span>
#include <vector>

#include "rift/gap/comparison.hpp"
#include "rift/gap/options.hpp"
#include "rift/statistics/inference.hpp"
#include "rift/trajectory/trajectory.hpp"

namespace rift::gap {

/// How one path looks, whoever drove it; NaN where a log cannot tell.
struct PathTraits {
  double speed_mps = kNotComputed;  ///< median of the speeds while it moves
  double weave_m = kNotComputed;    ///< RMS distance from its best straight line, evenly by length
};

PathTraits TraitsOf(const trajectory::Trajectory& path, const LikenessOptions& options);

/// Wavelength of the strongest weave in the mean spectrum of the paths, in m; NaN without a path
/// and when none weaves.
/// A path is taken as its distance from its best straight line over the length along it.
double DominantWavelength_m(std::span<const trajectory::Trajectory> paths,
                            const LikenessOptions& options);

/// The mean point of the paths at each u, over `options.points` of them; at least one path.
trajectory::Trajectory MeanPath(std::span<const trajectory::Trajectory> paths,
                                const LikenessOptions& options);

/// Gap of the mean of some runs to a real path; NaN without a run. With options.trim_standstill
/// each path is trimmed first, so that the mean is of what is left.
double MeanPathGap_m(const trajectory::Trajectory& real,
                     std::span<const trajectory::Trajectory> runs, const GapOptions& gap,
                     const LikenessOptions& options);

/// Repeats of one setting on both sides.
struct RepeatedSetting {
  std::vector<trajectory::Trajectory> reals;
  /// Either one list for each real path, of runs that set out as it did, or a single list of runs
  /// that know nothing of the single reals. Only runs that reached the end.
  std::vector<std::vector<trajectory::Trajectory>> sims;

  bool IsMatched() const { return sims.size() == reals.size(); }
};

/// One number of both sides, for the ratio that a like simulator has at 1.
struct BothSides {
  double sim = kNotComputed;
  double real = kNotComputed;
  /// Of the ratio, bootstrap over settings; NaN where it was not asked for, or for one setting.
  statistics::Interval ratio_interval{kNotComputed, kNotComputed};

  double Ratio() const { return sim / real; }
};

/// What tells a simulator that is like the robot from one that is merely close to it: a tame one
/// has a small gap and neither weaves nor spreads. NaN where there is nothing to tell it by.
struct Likeness {
  size_t reals = 0;
  size_t sims = 0;
  BothSides spread_m;                     ///< mean gap between repeats of a setting
  BothSides weave_m;                      ///< mean over the paths
  BothSides speed_mps;                    ///< mean over the paths of their median
  BothSides wavelength_m;                 ///< of the strongest weave
  double mean_gap_m = kNotComputed;       ///< simulated to real, mean over all pairs
  double mean_path_gap_m = kNotComputed;  ///< mean simulated path to each real one, mean over these
  /// Two-sample test on whole paths [Szekely and Rizzo 2004]: 0 when both sides have one
  /// distribution. p: share of the shuffles within the matched repeats that give as much.
  double energy_m = kNotComputed;
  double energy_p = kNotComputed;
  /// Share of the real paths that lie no further from the mean simulated path than the furthest
  /// simulated one does from the mean of the others, and what that share would be for a perfect
  /// simulator: K / (K + 1) of K runs.
  double inside_share = kNotComputed;
  double inside_expected = kNotComputed;
};

/// Throws std::invalid_argument when a setting has neither one list of runs nor one for each real,
/// or a path does not move.
Likeness MeasureLikeness(std::span<const RepeatedSetting> settings, const GapOptions& gap,
                         const LikenessOptions& options, std::mt19937_64& generator);

}  // namespace rift::gap
