#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "rift/experiment/experiment.hpp"
#include "rift/search/strategy.hpp"
#include "rift/sweep/falsify/options.hpp"
#include "rift/sweep/falsify/trial_runner.hpp"
#include "rift/sweep/falsify/verdict.hpp"

namespace rift::sweep {

/// A point that was tried.
struct TriedPoint {
  search::Point point;
  std::vector<TrialRow> rows;
  double loss = 0.0;
};

/// What a search over points of a space needs to know of its goal.
struct SearchGoal {
  int budget = 1;  ///< points
  int batch = 1;   ///< asked for at once; never the number of workers, on which nothing may depend
  /// The trials that tell what a point costs.
  std::function<std::vector<TrialRequest>(const search::Point&)> trials;
  /// Further trials of each point of a batch, asked again when they are run until there are none.
  std::function<std::vector<std::vector<TrialRequest>>(std::span<const TriedPoint>)> more;
  /// What it costs, of all its rows; NaN where they do not tell.
  std::function<double(std::span<const TrialRow>)> loss;
  /// Told each batch once it has all its trials; true ends the search.
  std::function<bool(std::span<const TriedPoint>)> is_enough;
};

struct SearchOutcome {
  std::vector<TriedPoint> points;  ///< in the order in which they were proposed
  std::string ended;               ///< "the budget", "the first hit", "every point", "the time"
};

/// Asked before trials are run: false ends the search in time.
using MayStart = std::function<bool(const std::vector<TrialRequest>&)>;

/// Asks a strategy, runs the trials, tells it, until the goal is met, the budget is spent, or
/// nothing is left to try. Nothing when the sweep was told to stop.
std::optional<SearchOutcome> Search(search::Strategy& strategy, const SearchGoal& goal,
                                    const RunTrials& run, const MayStart& may_start);

/// Whether the search went where earlier trials failed. The share of wrong verdicts is shown for
/// settings that no result chose.
bool IsChosenByResults(const Falsification& found);

/// Looks for settings that fail, repeats those that do until they are decided (RepeatPlan). The
/// result depends on the experiment alone. Nothing when it was told to stop. Throws
/// std::invalid_argument for a space without parameters or candidates that are logs.
std::optional<SweepResult> Falsify(const experiment::Experiment& experiment, const RunTrials& run,
                                   const MayStart& may_start);

}  // namespace rift::sweep
