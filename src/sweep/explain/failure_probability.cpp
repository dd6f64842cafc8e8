#include "rift/sweep/explain/failure_probability.hpp"

#include "rift/search/strategy.hpp"
#include "rift/sweep/falsify/settings.hpp"
#include "rift/sweep/falsify/verdict.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <span>
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
        fmt::format("How often it fails over the whole space is not known: the settings were {}",
                    estimate.untold > 0 ? "drawn at random, and none of their trials tells"
                                        : "chosen, not drawn at random");
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

/// One estimate, which asks for the robustness of points until it is done.
class Replica {
 public:
  Replica(int dimensions, std::uint64_t seed, const RareEventOptions& options)
      : random_(seed), options_(options) {
    for (int i = 0; i < options_.samples_per_level; ++i) {
      std::vector<double> point(static_cast<size_t>(dimensions));
      for (double& x : point) x = Uniform(random_);
      asked_.push_back(std::move(point));
    }
  }

  /// Empty when it is done.
  const std::vector<std::vector<double>>& Asked() const { return asked_; }

  /// Of the points asked for.
  void Take(std::span<const double> robustness) {
    std::vector<Sample> samples;
    for (size_t i = 0; i < asked_.size(); ++i) {
      const bool is_told = !std::isnan(robustness[i]);
      samples.push_back({std::move(asked_[i]),
                         is_told ? robustness[i] : std::numeric_limits<double>::infinity()});
      untold_ += !is_told;
    }
    evaluations_ += static_cast<int>(samples.size());
    asked_.clear();
    levels_ == 0 ? Begin(std::move(samples)) : Continue(std::move(samples));
    while (asked_.empty() && !is_done_) NextLevel();
  }

  /// What the levels that were passed leave; the estimate when failures were reached.
  double Bound() const { return bound_; }
  int Levels() const { return levels_; }
  int Evaluations() const { return evaluations_; }
  int Untold() const { return untold_; }
  bool IsReached() const { return is_reached_; }
  /// Of the first level: its draws are independent of each other.
  int ToldDraws() const { return told_draws_; }
  int FailedDraws() const { return failed_draws_; }

 private:
  void Begin(std::vector<Sample> draws) {
    told_draws_ = static_cast<int>(draws.size()) - untold_;
    for (Sample& draw : draws) {
      failed_draws_ += draw.robustness <= 0.0;
      chains_.push_back({std::move(draw)});
    }
  }

  /// A step of each chain that is not at its length, and what is asked for the next one.
  void Continue(std::vector<Sample> proposed) {
    auto next = proposed.begin();
    for (size_t i = 0; i < chains_.size(); ++i) {
      if (chains_[i].size() >= lengths_[i]) continue;
      const bool is_within = next->robustness <= level_;
      chains_[i].push_back(is_within ? std::move(*next) : chains_[i].back());
      ++next;
    }
    Ask();
  }

  void Ask() {
    for (size_t i = 0; i < chains_.size(); ++i) {
      if (chains_[i].size() < lengths_[i]) asked_.push_back(Moved(chains_[i].back().point));
    }
  }

  void NextLevel() {
    ++levels_;
    level_ = std::max(0.0, LevelOf(chains_));
    const double share = ShareBelow(chains_, level_);
    bound_ *= share;
    is_reached_ = level_ <= 0.0 && share > 0.0;
    is_done_ = level_ <= 0.0 || levels_ == options_.most_levels;
    if (!is_done_) Climb();
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
  void Climb() {
    std::vector<Sample> seeds;
    for (Chain& chain : chains_) {
      for (Sample& sample : chain) {
        if (sample.robustness <= level_) seeds.push_back(std::move(sample));
      }
    }
    SetReach(seeds);
    const size_t wanted = static_cast<size_t>(options_.samples_per_level);
    chains_.clear();
    lengths_.clear();
    for (size_t i = 0; i < seeds.size() && i < wanted; ++i) {
      const size_t length = wanted / seeds.size() + (i < wanted % seeds.size() ? 1 : 0);
      chains_.push_back({std::move(seeds[i])});
      lengths_.push_back(length);
    }
    Ask();
  }

  /// Moves as wide as the samples of the level lie apart, coordinate by coordinate: the deeper the
  /// level, the smaller it is.
  void SetReach(const std::vector<Sample>& seeds) {
    const double n = static_cast<double>(seeds.size());
    reach_.assign(seeds.front().point.size(), 0.0);
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
  std::vector<double> Moved(std::vector<double> point) {
    constexpr double kWide = 0.6, kMiddle = 0.28;
    const double kind = Uniform(random_);
    const double scale = kind < kWide ? 1.0 : kind < kWide + kMiddle ? 0.1 : 0.01;
    for (size_t i = 0; i < point.size(); ++i) {
      point[i] = Reflected(point[i] + scale * reach_[i] * (2.0 * Uniform(random_) - 1.0));
    }
    return point;
  }

  std::mt19937_64 random_;
  RareEventOptions options_;
  std::vector<std::vector<double>> asked_;
  std::vector<Chain> chains_;
  std::vector<size_t> lengths_;  ///< that the chains will have
  std::vector<double> reach_;
  double level_ = 0.0;
  double bound_ = 1.0;
  int levels_ = 0;
  int evaluations_ = 0;
  int untold_ = 0;
  int told_draws_ = 0;
  int failed_draws_ = 0;
  bool is_reached_ = false;
  bool is_done_ = false;
};

/// Asks for the next points of all of them at once; false: all are done.
bool Advance(std::span<Replica> replicas, const UnitRobustness& robustness) {
  std::vector<std::vector<double>> points;
  for (const Replica& replica : replicas) {
    points.insert(points.end(), replica.Asked().begin(), replica.Asked().end());
  }
  if (points.empty()) return false;
  const std::vector<double> values = robustness(points);
  size_t taken = 0;
  for (Replica& replica : replicas) {
    const size_t count = replica.Asked().size();
    if (count > 0) replica.Take(std::span(values).subspan(taken, count));
    taken += count;
  }
  return true;
}

/// Half of the draws fail: the rest of the replicas would say no more than that it is not rare.
bool IsCommon(const Replica& first) {
  constexpr double kShare = 0.5;
  return first.Levels() == 1 && first.IsReached() && first.Bound() >= kShare;
}

/// Of draws that all failed or not at once.
void CountDraws(const std::vector<Replica>& replicas, RareEvent& event) {
  double failures = 0.0;
  for (const Replica& replica : replicas) failures += replica.Bound() * replica.Evaluations();
  const int told = event.evaluations - event.untold;
  const statistics::Interval share =
      statistics::ClopperPearson(static_cast<int>(std::lround(failures)), told, kConfidence);
  event.probability = std::round(failures) / told;
  event.low = share.low;
  event.high = share.high;
}

/// Around the mean of the replicas, even in the logarithm, since their estimates are skewed; by
/// what skewness is left, Student's quantile of 97 % covers 95 %
/// (tests/sweep/explain/failures_test.cpp).
void MeasureScatter(const std::vector<double>& estimates, RareEvent& event) {
  constexpr double kQuantile = 0.986;
  event.coefficient_of_variation = statistics::StandardError(estimates) / event.probability;
  const double df = static_cast<double>(estimates.size()) - 1.0;
  const double reach = statistics::StudentQuantile(df, kQuantile) * event.coefficient_of_variation;
  event.low = event.probability * std::exp(-reach);
  event.high = std::min(1.0, event.probability * std::exp(reach));
}

/// The levels that were passed may have led past a region that nothing announces, so that what they
/// leave bounds nothing by itself: the draws do, which are independent (one-sided Clopper-Pearson).
double HighOfDraws(const std::vector<Replica>& replicas) {
  int told = 0, failed = 0;
  for (const Replica& replica : replicas) {
    told += replica.ToldDraws();
    failed += replica.FailedDraws();
  }
  return statistics::ClopperPearson(failed, told, 2.0 * kConfidence - 1.0).high;
}

RareEvent Conclude(const std::vector<Replica>& replicas) {
  RareEvent event;
  std::vector<double> estimates, bounds;
  for (const Replica& replica : replicas) {
    estimates.push_back(replica.IsReached() ? replica.Bound() : 0.0);
    bounds.push_back(replica.Bound());
    event.levels = std::max(event.levels, replica.Levels());
    event.evaluations += replica.Evaluations();
    event.untold += replica.Untold();
    event.is_reached = event.is_reached || replica.IsReached();
  }
  if (!event.is_reached) {
    event.high = std::max(statistics::Mean(bounds), HighOfDraws(replicas));
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
  const auto add = [&] {
    const std::uint64_t own_seed = statistics::SeedOfStream(seed, replicas.size() + 1);
    replicas.emplace_back(dimensions, own_seed, options);
  };
  add();
  Advance(replicas, robustness);
  if (IsCommon(replicas.front())) return Conclude(replicas);
  while (static_cast<int>(replicas.size()) < options.replicas) add();
  Advance(std::span(replicas).subspan(1), robustness);
  while (Advance(replicas, robustness)) continue;
  return Conclude(replicas);
}

namespace {

/// Whole numbers and lists get equal shares of the unit interval for each of their values.
double CoordinateOf(const search::Axis& axis, double x) {
  if (axis.kind == search::AxisKind::kContinuous) return axis.min + x * (axis.max - axis.min);
  return std::min(axis.max, axis.min + std::floor(x * (axis.max - axis.min + 1.0)));
}

/// At or below zero where it fails: a gap at the threshold does not exceed it, an end at the goal
/// that counts as a failure is one.
double RobustnessOf_m(const TrialRow& row, double threshold_m) {
  const double robustness_m = Robustness_m({&row, 1}, threshold_m);
  if (!row.Tells()) return robustness_m;
  return row.falsified ? std::min(robustness_m, 0.0)
                       : std::max(robustness_m, std::numeric_limits<double>::min());
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
  const UnitRobustness robustness_m = [&](const std::vector<std::vector<double>>& points) {
    std::vector<TrialRequest> trials;
    for (const std::vector<double>& unit : points) {
      const experiment::Theta theta = ThetaAtUnit(parameters, axes, unit);
      trials.push_back(FurtherTrials(experiment, theta, TrialKind::kComparison, runs, 1).front());
      trials.back().seed = FreshSeed(experiment.seed, static_cast<std::uint64_t>(++runs));
    }
    std::vector<double> values_m;
    for (const TrialRow& row : run(std::move(trials))) {
      values_m.push_back(RobustnessOf_m(row, experiment.gap.threshold_m));
    }
    return values_m;
  };
  return EstimateRareEvent(static_cast<int>(parameters.size()), robustness_m, experiment.seed,
                           options);
}

}  // namespace rift::sweep
