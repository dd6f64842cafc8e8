#include "rift/sweep/falsify/falsify.hpp"

#include <algorithm>
#include <cassert>
#include <iterator>
#include <limits>
#include <span>
#include <stdexcept>

#include "rift/sweep/falsify/result.hpp"
#include "rift/sweep/falsify/settings.hpp"
#include "rift/sweep/falsify/verdict.hpp"

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

/// How the repeats of a batch ended.
enum class Repeats { kDone, kOutOfTime, kStopped };

Repeats RunMore(Points& batch, const SearchGoal& goal, const RunTrials& run,
                const MayStart& may_start) {
  while (true) {
    Requests requests;
    std::vector<size_t> counts;
    for (Requests& more : goal.more(batch)) {
      counts.push_back(more.size());
      Append(requests, std::move(more));
    }
    if (requests.empty()) return Repeats::kDone;
    if (!may_start(requests)) return Repeats::kOutOfTime;
    if (!RunAll(batch, counts, std::move(requests), run)) return Repeats::kStopped;
  }
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
    if (!RunAll(batch, asked.counts, std::move(asked.requests), run)) return std::nullopt;
    const Repeats repeats = RunMore(batch, goal, run, may_start);
    if (repeats == Repeats::kStopped) return std::nullopt;
    for (TriedPoint& tried : batch) tried.loss = goal.loss(tried.rows);
    Tell(strategy, batch);
    const bool is_enough = goal.is_enough(batch);
    std::move(batch.begin(), batch.end(), std::back_inserter(outcome.points));
    if (is_enough || repeats == Repeats::kOutOfTime) {
      outcome.ended = is_enough ? "the first hit" : "the time";
      return outcome;
    }
  }
  outcome.ended = "the budget";
  return outcome;
}

namespace {

RepeatPlan::Settings RowsOf(std::span<const TriedPoint> batch) {
  RepeatPlan::Settings rows;
  for (const TriedPoint& tried : batch) rows.emplace_back(tried.rows);
  return rows;
}

/// The experiment and the plan must outlive the goal.
SearchGoal GoalOf(const experiment::Experiment& experiment, RepeatPlan& plan) {
  const std::vector<experiment::Parameter>& parameters = experiment.space.parameters;
  SearchGoal goal{.budget = experiment.search.budget, .batch = experiment.search.batch};
  const TrialKind kind = experiment.search.strategy == search::Method::kRandom
                             ? TrialKind::kRandomDraw
                             : TrialKind::kComparison;
  goal.trials = [&, kind](const search::Point& point) {
    return TrialsAt(experiment, ThetaAt(parameters, point), kind);
  };
  goal.more = [&, kind](std::span<const TriedPoint> batch) {
    const std::vector<int> more = plan.More(RowsOf(batch));
    std::vector<Requests> requests;
    for (size_t i = 0; i < batch.size(); ++i) {
      requests.push_back(FurtherTrials(experiment, ThetaAt(parameters, batch[i].point), kind,
                                       static_cast<int>(batch[i].rows.size()), more[i]));
    }
    return requests;
  };
  goal.loss = [&](std::span<const TrialRow> rows) {
    return Robustness_m(rows, experiment.gap.threshold_m);
  };
  goal.is_enough = [&](std::span<const TriedPoint> batch) {
    plan.Add(RowsOf(batch));
    return experiment.falsify.until == Until::kFirst && plan.HasFalsified();
  };
  return goal;
}

gap::Verdict VerdictOf(const SweepResult& result) {
  const auto has = [&](gap::Verdict verdict) { return result.Count(verdict) > 0; };
  for (const gap::Verdict verdict :
       {gap::Verdict::kFalsified, gap::Verdict::kUndecided, gap::Verdict::kNotSeenToFail}) {
    if (has(verdict)) return verdict;
  }
  return gap::Verdict::kPassed;
}

Falsification Judge(const SearchOutcome& outcome, const SweepResult& result,
                    const SearchPlan& search) {
  Falsification found{.verdict = VerdictOf(result),
                      .evaluations = static_cast<int>(outcome.points.size()),
                      .budget = search.budget,
                      .ended = outcome.ended};
  found.strategy = EnumNames(search.strategy)[static_cast<size_t>(search.strategy)];
  double worst_loss = std::numeric_limits<double>::infinity();
  for (size_t i = 0; i < outcome.points.size(); ++i) {
    const bool is_falsified = result.settings[i].verdict.verdict == gap::Verdict::kFalsified;
    if (is_falsified && !found.first_evaluation) {
      found.first_evaluation = static_cast<int>(i) + 1;
      worst_loss = std::numeric_limits<double>::infinity();  // only falsified ones from here on
    }
    const bool may_be_worst = is_falsified || !found.first_evaluation;
    if (may_be_worst && outcome.points[i].loss < worst_loss) {
      worst_loss = outcome.points[i].loss;
      found.worst_setting = static_cast<int>(i);
    }
  }
  return found;
}

}  // namespace

bool IsChosenByResults(const Falsification& found) {
  using search::Method;
  for (const Method blind :
       {Method::kRandom, Method::kSobol, Method::kLatinHypercube, Method::kCorners}) {
    if (found.strategy == EnumNames(blind)[static_cast<size_t>(blind)]) return false;
  }
  return true;
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
  RepeatPlan plan(experiment.falsify, search.budget, experiment.gap.threshold_m);
  std::optional<SearchOutcome> outcome =
      Search(*strategy, GoalOf(experiment, plan), run, may_start);
  if (!outcome) return std::nullopt;
  SweepResult result = EmptyResult(experiment);
  result.judged_settings = search.budget;
  for (const TriedPoint& tried : outcome->points) {
    result.rows.insert(result.rows.end(), tried.rows.begin(), tried.rows.end());
  }
  Summarise(result);
  assert(result.settings.size() == outcome->points.size());  // no point is proposed twice
  result.falsification = Judge(*outcome, result, search);
  return result;
}

}  // namespace rift::sweep
