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

namespace rift::sweep {

FailureProbability EstimateFailureProbability(const SweepResult& result) {
  FailureProbability estimate;
  std::vector<double> is_failure;
  for (const SettingResult& setting : result.settings) {
    const bool is_draw = result.rows[setting.rows.front()].is_random_draw;
    if (!is_draw) continue;
    if (setting.verdict.repeats == 0) {
      ++estimate.without_gap;
    } else {
      is_failure.push_back(setting.verdict.above > 0 ? 1.0 : 0.0);
    }
  }
  const gap::RepeatVerdict verdict = gap::JudgeRepeats(is_failure, 0.5, estimate.confidence);
  estimate.draws = verdict.repeats;
  estimate.failures = verdict.above;
  if (estimate.draws == 0) {
    estimate.sentence =
        "How often it fails over the whole space is not known: the settings were chosen, not drawn "
        "at random";
    return estimate;
  }
  estimate.low = verdict.share_low;
  estimate.high = verdict.share_high;
  estimate.share = static_cast<double>(estimate.failures) / estimate.draws;
  estimate.sentence = fmt::format(
      "Over the space {:.3g} % of the settings fail, between {:.3g} and {:.3g} % with 95 % "
      "confidence (Clopper-Pearson, {} of {} settings drawn at random{})",
      100.0 * estimate.share, 100.0 * estimate.low, 100.0 * estimate.high, estimate.failures,
      estimate.draws,
      estimate.without_gap > 0 ? fmt::format("; {} more gave no gap", estimate.without_gap) : "");
  return estimate;
}

namespace {

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

class SubsetSimulation {
 public:
  SubsetSimulation(int dimensions, const UnitRobustness& robustness, std::uint64_t seed,
                   const RareEventOptions& options)
      : dimensions_(dimensions), robustness_(robustness), random_(seed), options_(options) {}

  RareEvent Run() {
    std::vector<Chain> chains;
    for (int i = 0; i < options_.samples_per_level; ++i) chains.push_back({Draw()});
    double probability = 1.0, variance = 0.0;
    for (event_.levels = 1;; ++event_.levels) {
      const double level = std::max(0.0, LevelOf(chains));
      const double share = ShareBelow(chains, level);
      variance += SquaredError(chains, level, share);
      probability *= share;
      event_.is_reached = level <= 0.0 && share > 0.0;
      if (level <= 0.0 || event_.levels == options_.most_levels) break;
      chains = Climb(chains, level);
    }
    Conclude(probability, variance);
    return event_;
  }

 private:
  Sample Evaluated(std::vector<double> point) {
    double robustness = robustness_(point);
    if (std::isnan(robustness)) robustness = std::numeric_limits<double>::infinity();
    ++event_.evaluations;
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

  /// Squared coefficient of variation of the share, samples of a chain being alike (Au and Beck,
  /// equation 28): the variance of the chains' sums, which are independent of each other.
  static double SquaredError(const std::vector<Chain>& chains, double level, double share) {
    if (share <= 0.0) return std::numeric_limits<double>::infinity();
    double squares = 0.0, all = 0.0;
    for (const Chain& chain : chains) {
      double sum = 0.0;
      for (const Sample& sample : chain) sum += (sample.robustness <= level) - share;
      squares += sum * sum;
      all += static_cast<double>(chain.size());
    }
    return squares / std::pow(all * share, 2);
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

  Sample Step(const Sample& from, double level) {
    std::vector<double> point = from.point;
    for (size_t i = 0; i < point.size(); ++i) {
      point[i] = Reflected(point[i] + reach_[i] * (2.0 * Uniform(random_) - 1.0));
    }
    Sample to = Evaluated(std::move(point));
    return to.robustness <= level ? to : from;
  }

  void Conclude(double probability, double variance) {
    event_.probability = probability;
    if (!event_.is_reached) {
      event_.high = probability;
      return;
    }
    event_.coefficient_of_variation = std::sqrt(variance);
    const double spread = statistics::NormalQuantile(0.975) * std::sqrt(std::log1p(variance));
    event_.low = probability * std::exp(-spread);
    event_.high = std::min(1.0, probability * std::exp(spread));
  }

  int dimensions_;
  const UnitRobustness& robustness_;
  std::mt19937_64 random_;
  RareEventOptions options_;
  std::vector<double> reach_;
  RareEvent event_;
};

}  // namespace

RareEvent EstimateRareEvent(int dimensions, const UnitRobustness& robustness, std::uint64_t seed,
                            const RareEventOptions& options) {
  if (dimensions < 1) {
    throw std::invalid_argument("a rare event needs a space of at least one parameter");
  }
  return SubsetSimulation(dimensions, robustness, seed, options).Run();
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

/// Of the worst trial; NaN when none tells.
double WorstRobustness_m(std::span<const TrialRow> rows, double threshold_m) {
  double worst_m = std::numeric_limits<double>::quiet_NaN();
  for (size_t i = 0; i < rows.size(); ++i) {
    worst_m = std::fmin(worst_m, Robustness_m(rows.subspan(i, 1), threshold_m));
  }
  return worst_m;
}

}  // namespace

RareEvent EstimateRareEvent(const experiment::Experiment& experiment, const RunAllTrials& run,
                            const RareEventOptions& options) {
  const std::vector<experiment::Parameter>& parameters = experiment.space.parameters;
  const std::vector<search::Axis> axes = AxesOf(parameters);
  const UnitRobustness robustness_m = [&](std::span<const double> unit) {
    const std::vector<TrialRow> rows =
        run(TrialsAt(experiment, ThetaAtUnit(parameters, axes, unit)));
    return WorstRobustness_m(rows, experiment.gap.threshold_m);
  };
  return EstimateRareEvent(static_cast<int>(parameters.size()), robustness_m, experiment.seed,
                           options);
}

}  // namespace rift::sweep
