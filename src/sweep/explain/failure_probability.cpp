#include "rift/sweep/explain/failure_probability.hpp"

#include "rift/search/strategy.hpp"
#include "rift/sweep/falsify/grid.hpp"
#include "rift/sweep/falsify/search_space.hpp"
#include "rift/sweep/falsify/verdict.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

#include "rift/statistics/descriptive.hpp"
#include "rift/statistics/inference.hpp"
#include "rift/statistics/random.hpp"

namespace rift::sweep {

FailureProbability EstimateFailureProbability(const SweepResult& result) {
  FailureProbability estimate;
  for (const SettingResult& setting : result.settings) {
    const bool is_draw = result.rows[setting.rows.front()].is_random_draw;
    if (!is_draw) continue;
    // Further trials are made of settings that failed: they would count those twice.
    const auto first = std::find_if(setting.rows.begin(), setting.rows.end(),
                                    [&](int row) { return result.rows[row].Tells(); });
    if (first == setting.rows.end()) {
      ++estimate.untold;
    } else {
      ++estimate.draws;
      estimate.failures += result.rows[*first].falsified;
    }
  }
  if (estimate.draws == 0) {
    estimate.sentence =
        "How often it fails over the whole space is not known: the settings were chosen, not drawn "
        "at random";
    return estimate;
  }
  const statistics::Interval share =
      statistics::ClopperPearson(estimate.failures, estimate.draws, estimate.confidence);
  estimate.low = share.low;
  estimate.high = share.high;
  estimate.share = static_cast<double>(estimate.failures) / estimate.draws;
  estimate.sentence = fmt::format(
      "Over the space {:.3g} % of the runs fail, between {:.3g} and {:.3g} % with 95 % "
      "confidence (Clopper-Pearson, {} of {} runs, each at a setting drawn at random{})",
      100.0 * estimate.share, 100.0 * estimate.low, 100.0 * estimate.high, estimate.failures,
      estimate.draws,
      estimate.untold > 0 ? fmt::format("; {} more do not tell", estimate.untold) : "");
  return estimate;
}

namespace {

constexpr double kConfidence = 0.95;

/// In [0, 1), the same on every platform.
double Uniform(std::mt19937_64& random) { return static_cast<double>(random() >> 11) * 0x1.0p-53; }

/// Folds a value that left [0, 1] back in, which keeps the even distribution.
double Reflected(double x) {
  x = std::fmod(std::abs(x), 2.0);
  return x > 1.0 ? 2.0 - x : x;
}

struct Sample {
  std::vector<double> point;
  double robustness = 0.0;
};

using Chain = std::vector<Sample>;

struct Replica {
  double bound = 1.0;
  int levels = 0;
  int evaluations = 0;
  bool is_reached = false;
};

class SubsetSimulation {
 public:
  SubsetSimulation(int dimensions, const UnitRobustness& robustness, std::uint64_t seed,
                   const RareEventOptions& options)
      : dimensions_(dimensions), robustness_(robustness), random_(seed), options_(options) {}

  /// `bound` is what the levels that were passed leave; the estimate when failures were reached.
  Replica Run() {
    std::vector<Chain> chains;
    for (int i = 0; i < options_.samples_per_level; ++i) chains.push_back({Draw()});
    Replica replica{.bound = 1.0};
    for (replica.levels = 1;; ++replica.levels) {
      const double level = std::max(0.0, LevelOf(chains));
      const double share = ShareBelow(chains, level);
      replica.bound *= share;
      replica.is_reached = level <= 0.0 && share > 0.0;
      if (level <= 0.0 || replica.levels == options_.most_levels) break;
      chains = Climb(chains, level);
    }
    replica.evaluations = evaluations_;
    return replica;
  }

 private:
  Sample Evaluated(std::vector<double> point) {
    double robustness = robustness_(point);
    if (std::isnan(robustness)) robustness = std::numeric_limits<double>::infinity();
    ++evaluations_;
    return {std::move(point), robustness};
  }

  Sample Draw() {
    std::vector<double> point(static_cast<size_t>(dimensions_));
    for (double& x : point) x = Uniform(random_);
    return Evaluated(std::move(point));
  }

  double LevelOf(const std::vector<Chain>& chains) const {
    std::vector<double> all;
    for (const Chain& chain : chains) {
      for (const Sample& sample : chain) all.push_back(sample.robustness);
    }
    return statistics::Quantile(std::move(all), options_.level_share);
  }

  static double ShareBelow(const std::vector<Chain>& chains, double level) {
    double below = 0.0, all = 0.0;
    for (const Chain& chain : chains) {
      for (const Sample& sample : chain) {
        below += sample.robustness <= level;
        all += 1.0;
      }
    }
    return below / all;
  }

  /// From every sample below the level a Markov chain within it, as many samples as before.
  std::vector<Chain> Climb(const std::vector<Chain>& chains, double level) {
    std::vector<Sample> seeds;
    for (const Chain& chain : chains) {
      for (const Sample& sample : chain) {
        if (sample.robustness <= level) seeds.push_back(sample);
      }
    }
    SetReach(seeds);
    std::vector<Chain> next;
    const size_t wanted = static_cast<size_t>(options_.samples_per_level);
    for (size_t i = 0; i < seeds.size() && i < wanted; ++i) {
      const size_t length = wanted / seeds.size() + (i < wanted % seeds.size() ? 1 : 0);
      Chain chain{seeds[i]};
      while (chain.size() < std::max<size_t>(length, 1)) chain.push_back(Step(chain.back(), level));
      next.push_back(std::move(chain));
    }
    return next;
  }

  /// Moves as wide as the samples of the level lie apart, coordinate by coordinate: the deeper the
  /// level, the smaller it is.
  void SetReach(const std::vector<Sample>& seeds) {
    const double n = static_cast<double>(seeds.size());
    reach_.assign(static_cast<size_t>(dimensions_), 0.0);
    for (size_t i = 0; i < reach_.size(); ++i) {
      double sum = 0.0, squares = 0.0;
      for (const Sample& seed : seeds) {
        sum += seed.point[i];
        squares += seed.point[i] * seed.point[i];
      }
      reach_[i] = options_.step * std::sqrt(std::max(0.0, squares / n - sum * sum / n / n));
    }
  }

  /// Some moves are finer: regions that lie apart make the reach wide, and each of them may be
  /// narrow.
  Sample Step(const Sample& from, double level) {
    constexpr double kWide = 0.6, kMiddle = 0.28;
    const double kind = Uniform(random_);
    const double scale = kind < kWide ? 1.0 : kind < kWide + kMiddle ? 0.1 : 0.01;
    std::vector<double> point = from.point;
    for (size_t i = 0; i < point.size(); ++i) {
      point[i] = Reflected(point[i] + scale * reach_[i] * (2.0 * Uniform(random_) - 1.0));
    }
    Sample to = Evaluated(std::move(point));
    return to.robustness <= level ? to : from;
  }

  int dimensions_;
  const UnitRobustness& robustness_;
  std::mt19937_64 random_;
  RareEventOptions options_;
  std::vector<double> reach_;
  int evaluations_ = 0;
};

/// Of draws that all failed or not at once.
void CountDraws(const std::vector<Replica>& replicas, RareEvent& event) {
  double failures = 0.0;
  for (const Replica& replica : replicas) failures += replica.bound * replica.evaluations;
  const statistics::Interval share = statistics::ClopperPearson(
      static_cast<int>(std::lround(failures)), event.evaluations, kConfidence);
  event.low = share.low;
  event.high = share.high;
}

/// Around the mean of the replicas, even in the logarithm, since their estimates are skewed; by
/// what skewness is left, Student's quantile of 97 % covers 95 % (tests/sweep/failures_test.cpp).
void MeasureScatter(const std::vector<double>& estimates, RareEvent& event) {
  constexpr double kQuantile = 0.986;
  event.coefficient_of_variation = statistics::StandardError(estimates) / event.probability;
  const double df = static_cast<double>(estimates.size()) - 1.0;
  const double reach = statistics::StudentQuantile(df, kQuantile) * event.coefficient_of_variation;
  event.low = event.probability * std::exp(-reach);
  event.high = std::min(1.0, event.probability * std::exp(reach));
}

RareEvent Conclude(const std::vector<Replica>& replicas) {
  RareEvent event;
  std::vector<double> estimates, bounds;
  for (const Replica& replica : replicas) {
    estimates.push_back(replica.is_reached ? replica.bound : 0.0);
    bounds.push_back(replica.bound);
    event.levels = std::max(event.levels, replica.levels);
    event.evaluations += replica.evaluations;
    event.is_reached = event.is_reached || replica.is_reached;
  }
  if (!event.is_reached) {
    event.probability = event.high = statistics::Mean(bounds);
    return event;
  }
  event.probability = statistics::Mean(estimates);
  event.levels == 1 ? CountDraws(replicas, event) : MeasureScatter(estimates, event);
  return event;
}

}  // namespace

RareEvent EstimateRareEvent(int dimensions, const UnitRobustness& robustness, std::uint64_t seed,
                            const RareEventOptions& options) {
  if (dimensions < 1) {
    throw std::invalid_argument("a rare event needs a space of at least one parameter");
  }
  std::vector<Replica> replicas;
  for (int i = 0; i < options.replicas; ++i) {
    const std::uint64_t own_seed =
        statistics::SeedOfStream(seed, static_cast<std::uint64_t>(i) + 1);
    replicas.push_back(SubsetSimulation(dimensions, robustness, own_seed, options).Run());
  }
  return Conclude(replicas);
}

namespace {

/// Whole numbers and lists get equal shares of the unit interval for each of their values.
double CoordinateOf(const search::Axis& axis, double x) {
  if (axis.kind == search::AxisKind::kContinuous) return axis.min + x * (axis.max - axis.min);
  return std::min(axis.max, axis.min + std::floor(x * (axis.max - axis.min + 1.0)));
}

experiment::Theta ThetaAtUnit(const std::vector<experiment::Parameter>& parameters,
                              const std::vector<search::Axis>& axes, std::span<const double> unit) {
  search::Point point;
  for (size_t i = 0; i < axes.size(); ++i) point.push_back(CoordinateOf(axes[i], unit[i]));
  return ThetaAt(parameters, point);
}

}  // namespace

RareEvent EstimateRareEvent(const experiment::Experiment& experiment, const RunAllTrials& run,
                            const RareEventOptions& options) {
  const std::vector<experiment::Parameter>& parameters = experiment.space.parameters;
  const std::vector<search::Axis> axes = AxesOf(parameters);
  int runs = 0;
  const UnitRobustness robustness_m = [&](std::span<const double> unit) {
    const experiment::Theta theta = ThetaAtUnit(parameters, axes, unit);
    std::vector<TrialRequest> trial =
        FurtherTrials(experiment, theta, TrialKind::kComparison, runs, 1);
    trial.front().seed = FreshSeed(experiment.seed, static_cast<std::uint64_t>(++runs));
    return Robustness_m(run(std::move(trial)), experiment.gap.threshold_m);
  };
  return EstimateRareEvent(static_cast<int>(parameters.size()), robustness_m, experiment.seed,
                           options);
}

}  // namespace rift::sweep
