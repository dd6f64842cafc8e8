#include "rift/sweep/falsify/falsify.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <iterator>
#include <limits>
#include <stdexcept>

#include "rift/statistics/mean.hpp"
#include "rift/sweep/falsify/grid.hpp"
#include "rift/sweep/falsify/search_space.hpp"
#include "rift/sweep/falsify/summary.hpp"

namespace rift::sweep {
namespace {

/// Gaps of the trials that tell; a fall that counts is above any threshold.
std::vector<double> Gaps(std::span<const TrialRow> rows, double fall_m) {
  std::vector<double> gaps_m;
  for (const TrialRow& row : rows) {
    if (row.IsOk()) {
      gaps_m.push_back(row.comparison.gap_m);
    } else if (row.falsified) {
      gaps_m.push_back(fall_m);
    }
  }
  return gaps_m;
}

bool HasFailure(std::span<const TrialRow> rows) {
  return std::any_of(rows.begin(), rows.end(), [](const TrialRow& row) { return row.falsified; });
}

/// The repeats that a setting gets beyond its first trials: all or none of them, at once.
std::vector<TrialRequest> MoreTrials(const experiment::Experiment& experiment,
                                     const experiment::Theta& theta,
                                     std::span<const TrialRow> rows) {
  const double robustness_m = Robustness_m(rows, experiment.gap.threshold_m);
  const bool is_near = HasFailure(rows) || std::abs(robustness_m) <= experiment.falsify.near_m;
  std::vector<TrialRequest> requests;
  if (!is_near) return requests;
  const size_t most = static_cast<size_t>(experiment.falsify.most_repeats);
  for (int repeat = 1; rows.size() + requests.size() < most; ++repeat) {
    for (TrialRequest& request : TrialsAt(experiment, theta, repeat)) {
      requests.push_back(std::move(request));
    }
  }
  return requests;
}

/// The experiment must outlive the goal.
SearchGoal GoalOf(const experiment::Experiment& experiment) {
  const std::vector<experiment::Parameter>& parameters = experiment.space.parameters;
  SearchGoal goal{.budget = experiment.search.budget, .batch = experiment.search.batch};
  const bool is_random = experiment.search.strategy == search::Method::kRandom;
  goal.trials = [&, is_random](const search::Point& point) {
    std::vector<TrialRequest> requests = TrialsAt(experiment, ThetaAt(parameters, point));
    for (TrialRequest& request : requests) request.is_random_draw = is_random;
    return requests;
  };
  goal.more = [&](const search::Point& point, std::span<const TrialRow> rows) {
    return MoreTrials(experiment, ThetaAt(parameters, point), rows);
  };
  goal.loss = [&](std::span<const TrialRow> rows) {
    return Robustness_m(rows, experiment.gap.threshold_m);
  };
  goal.is_enough = [&](std::span<const TrialRow> rows) {
    return experiment.falsify.until == Until::kFirst &&
           JudgeSetting(rows, experiment.falsify) == gap::Verdict::kFalsified;
  };
  return goal;
}

/// Each row as a number above or below 0.5: it was judged by the threshold already.
gap::RepeatVerdict CountFailures(std::span<const TrialRow> rows, double confidence) {
  std::vector<double> failures;
  for (const TrialRow& row : rows) {
    if (row.IsOk() || row.falsified) failures.push_back(row.falsified ? 1.0 : 0.0);
  }
  return gap::JudgeRepeats(failures, 0.5, confidence);
}

gap::Verdict Decide(const gap::RepeatVerdict& repeats, double share) {
  if (repeats.repeats == 0) return gap::Verdict::kUndecided;
  if (repeats.share_low > share) return gap::Verdict::kFalsified;
  if (repeats.share_high < share) return gap::Verdict::kNotFalsified;
  return gap::Verdict::kUndecided;
}

/// A setting far from the threshold had one trial, which proves little, but nothing speaks against
/// it either: only failures leave a doubt.
std::vector<gap::RepeatVerdict> JudgeAll(const SearchOutcome& outcome,
                                         const FalsifyOptions& options) {
  std::vector<gap::RepeatVerdict> verdicts;
  for (const TriedPoint& tried : outcome.points) {
    verdicts.push_back(CountFailures(tried.rows, options.confidence));
    if (verdicts.back().above > 0) verdicts.back().verdict = Decide(verdicts.back(), options.share);
  }
  return verdicts;
}

Falsification Judge(const SearchOutcome& outcome, const std::vector<gap::RepeatVerdict>& verdicts,
                    const SearchPlan& search, const FalsifyOptions& options) {
  Falsification found{.confidence = options.confidence,
                      .share = options.share,
                      .evaluations = static_cast<int>(outcome.points.size()),
                      .budget = search.budget,
                      .ended = outcome.ended};
  found.strategy = EnumNames(search.strategy)[static_cast<size_t>(search.strategy)];
  double worst_loss = std::numeric_limits<double>::infinity();
  for (size_t i = 0; i < outcome.points.size(); ++i) {
    const TriedPoint& tried = outcome.points[i];
    const bool is_falsified = verdicts[i].verdict == gap::Verdict::kFalsified;
    found.falsified += is_falsified;
    found.undecided += verdicts[i].verdict == gap::Verdict::kUndecided && verdicts[i].above > 0;
    if (is_falsified && !found.first_evaluation) {
      found.first_evaluation = static_cast<int>(i) + 1;
      worst_loss = std::numeric_limits<double>::infinity();  // only falsified ones from here on
    }
    const bool may_be_worst = is_falsified || !found.first_evaluation;
    if (may_be_worst && tried.loss < worst_loss) {
      worst_loss = tried.loss;
      found.worst_setting = static_cast<int>(i);
    }
  }
  if (found.undecided > 0) found.verdict = gap::Verdict::kUndecided;
  if (found.falsified > 0) found.verdict = gap::Verdict::kFalsified;
  return found;
}

}  // namespace

gap::Verdict JudgeSetting(std::span<const TrialRow> rows, const FalsifyOptions& options) {
  return Decide(CountFailures(rows, options.confidence), options.share);
}

double TrialsToFalsify(const FalsifyOptions& options) {
  if (options.share >= 1.0) return std::numeric_limits<double>::infinity();
  const double tail = (1.0 - options.confidence) / 2.0;
  // n failures of n: the lower bound is tail^(1/n) (Clopper and Pearson 1934).
  return std::floor(std::log(tail) / std::log(options.share)) + 1.0;
}

double Robustness_m(std::span<const TrialRow> rows, double threshold_m) {
  return threshold_m - statistics::Mean(Gaps(rows, 2.0 * threshold_m));
}

std::optional<SweepResult> Falsify(const experiment::Experiment& experiment, const RunTrials& run,
                                   const MayStart& may_start) {
  const std::vector<experiment::Parameter>& parameters = experiment.space.parameters;
  if (parameters.empty()) {
    throw std::invalid_argument("goal is falsify, and space has no parameters to search");
  }
  const std::optional<std::uint64_t> seed = FirstSeed(experiment);
  if (!seed) {
    throw std::invalid_argument(
        "goal is falsify, and candidate.kind is logs: only simulated trials can be searched");
  }
  const SearchPlan& search = experiment.search;
  const std::unique_ptr<search::Strategy> strategy =
      search::MakeStrategy(search, AxesOf(parameters), search.budget, *seed);
  std::optional<SearchOutcome> outcome = Search(*strategy, GoalOf(experiment), run, may_start);
  if (!outcome) return std::nullopt;
  SweepResult result = EmptyResult(experiment);
  const std::vector<gap::RepeatVerdict> verdicts = JudgeAll(*outcome, experiment.falsify);
  result.falsification = Judge(*outcome, verdicts, search, experiment.falsify);
  for (TriedPoint& tried : outcome->points) {
    std::move(tried.rows.begin(), tried.rows.end(), std::back_inserter(result.rows));
  }
  Summarise(result);
  assert(result.settings.size() == verdicts.size());  // no point is proposed twice
  for (size_t i = 0; i < verdicts.size(); ++i) result.settings[i].verdict = verdicts[i];
  return result;
}

}  // namespace rift::sweep
