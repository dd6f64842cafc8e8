#include "rift/sweep/falsify/falsify.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <iterator>
#include <limits>
#include <stdexcept>

#include "rift/statistics/descriptive.hpp"
#include "rift/sweep/falsify/grid.hpp"
#include "rift/sweep/falsify/result.hpp"
#include "rift/sweep/falsify/search_space.hpp"

namespace rift::sweep {

namespace {

using Points = std::vector<TriedPoint>;
using Requests = std::vector<TrialRequest>;

void Append(Requests& all, Requests more) {
  all.insert(all.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
}

/// Runs the trials of all points at once, so that no worker waits at the end of each.
bool RunAll(Points& batch, const std::vector<size_t>& counts, Requests requests,
            const RunTrials& run) {
  std::optional<std::vector<TrialRow>> rows = run(std::move(requests));
  if (!rows) return false;
  auto next = std::make_move_iterator(rows->begin());
  for (size_t i = 0; i < batch.size(); ++i) {
    const auto end = next + static_cast<std::ptrdiff_t>(counts[i]);
    batch[i].rows.insert(batch[i].rows.end(), next, end);
    next = end;
  }
  return true;
}

struct Asked {
  Points batch;
  std::vector<size_t> counts;
  Requests requests;
};

Asked Ask(search::Strategy& strategy, const SearchGoal& goal, int most) {
  Asked asked;
  for (search::Point& point : strategy.Ask(most)) {
    Requests trials = goal.trials(point);
    asked.counts.push_back(trials.size());
    Append(asked.requests, std::move(trials));
    asked.batch.push_back({std::move(point), {}, 0.0});
  }
  return asked;
}

bool RunMore(Points& batch, const SearchGoal& goal, const RunTrials& run) {
  if (!goal.more) return true;
  Requests requests;
  std::vector<size_t> counts;
  for (const TriedPoint& tried : batch) {
    Requests more = goal.more(tried.point, tried.rows);
    counts.push_back(more.size());
    Append(requests, std::move(more));
  }
  return requests.empty() || RunAll(batch, counts, std::move(requests), run);
}

void Tell(search::Strategy& strategy, const Points& batch) {
  std::vector<search::Evaluation> evaluations;
  for (const TriedPoint& tried : batch) evaluations.push_back({tried.point, tried.loss});
  strategy.Tell(evaluations);
}

}  // namespace

std::optional<SearchOutcome> Search(search::Strategy& strategy, const SearchGoal& goal,
                                    const RunTrials& run, const MayStart& may_start) {
  SearchOutcome outcome;
  while (static_cast<int>(outcome.points.size()) < goal.budget) {
    const int left = goal.budget - static_cast<int>(outcome.points.size());
    Asked asked = Ask(strategy, goal, std::min(left, goal.batch));
    if (asked.batch.empty()) {
      outcome.ended = "every point of the space";
      return outcome;
    }
    if (!may_start(asked.requests)) {
      outcome.ended = "the time";
      return outcome;
    }
    Points& batch = asked.batch;
    const bool is_whole =
        RunAll(batch, asked.counts, std::move(asked.requests), run) && RunMore(batch, goal, run);
    if (!is_whole) return std::nullopt;
    for (TriedPoint& tried : batch) tried.loss = goal.loss(tried.rows);
    Tell(strategy, batch);
    const bool is_enough = std::any_of(batch.begin(), batch.end(), [&](const TriedPoint& tried) {
      return goal.is_enough(tried.rows);
    });
    std::move(batch.begin(), batch.end(), std::back_inserter(outcome.points));
    if (is_enough) {
      outcome.ended = "the first hit";
      return outcome;
    }
  }
  outcome.ended = "the budget";
  return outcome;
}

namespace {

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

/// A setting far from the threshold had one trial, which proves little, but nothing speaks against
/// it either: only failures leave a doubt.
std::vector<gap::RepeatVerdict> JudgeAll(const SearchOutcome& outcome,
                                         const FalsifyOptions& options) {
  std::vector<gap::RepeatVerdict> verdicts;
  for (const TriedPoint& tried : outcome.points) {
    verdicts.push_back(CountFailures(tried.rows, options.confidence));
    if (verdicts.back().above > 0) verdicts.back().verdict = JudgeSetting(tried.rows, options);
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
