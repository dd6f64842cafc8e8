#pragma once

#include <cstdint>
#include <vector>

#include "rift/gap/comparison.hpp"
#include "rift/gap/options.hpp"
#include "rift/statistics/inference.hpp"
#include "rift/sweep/calibrate/repeated_trial.hpp"

namespace rift::sweep {

/// How far the mean of a real trial's simulated runs is from it, beside how far the other real
/// trials of its setting are: pairs over the same real paths, which have both.
struct PathPrediction {
  size_t reals = 0;
  double simulated_m = gap::kNotComputed;   ///< gap of the mean simulated path, mean over the reals
  double other_real_m = gap::kNotComputed;  ///< of the other real trials
  double difference_m = gap::kNotComputed;  ///< below zero: the simulator predicts better
  statistics::Interval difference_interval_m{gap::kNotComputed, gap::kNotComputed};  ///< settings
};

PathPrediction MeasurePrediction(const std::vector<RepeatedTrial>& trials,
                                 const gap::GapOptions& gap, const gap::LikenessOptions& options,
                                 std::uint64_t seed);

/// Whether the simulator ranks the settings as the robot does (as in Kadian et al. 2020, "Sim2Real
/// predictivity"): rank correlation of the gap to the straight lines between the waypoints over the
/// settings, of the last real trial of each with the mean of its simulated runs, and with the mean
/// of the other real trials of the setting. NaN for fewer than three settings.
struct RankAgreement {
  size_t settings = 0;  ///< that have both
  double simulated = gap::kNotComputed;
  statistics::Interval simulated_interval{gap::kNotComputed, gap::kNotComputed};
  double real = gap::kNotComputed;
  statistics::Interval real_interval{gap::kNotComputed, gap::kNotComputed};
};

RankAgreement MeasureRanks(const std::vector<RepeatedTrial>& trials, const gap::GapOptions& gap,
                           const gap::LikenessOptions& options, std::uint64_t seed);

}  // namespace rift::sweep
