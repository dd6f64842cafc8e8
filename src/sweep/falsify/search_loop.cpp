#include "rift/sweep/falsify/search_loop.hpp"

#include <algorithm>
#include <iterator>

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

}  // namespace rift::sweep
