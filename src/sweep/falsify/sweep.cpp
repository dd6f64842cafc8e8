#include "rift/sweep/falsify/sweep.hpp"

#include <cstdint>
#include <iterator>
#include <set>
#include <stdexcept>
#include <utility>
#include <vector>

namespace rift::sweep {
namespace {

std::optional<SweepResult> RunGoal(const experiment::Experiment& experiment, const RunTrials& run,
                                   const MayStart& may_start) {
  switch (experiment.goal) {
    case experiment::Goal::kGrid:
      return SweepGrid(experiment, run);
    case experiment::Goal::kFalsify:
      return Falsify(experiment, run, may_start);
    case experiment::Goal::kCalibrate:
      break;
  }
  throw std::logic_error("goal: calibrate is no search over a space");
}

/// Those that a row was held against, or would have been. The check looks further than most
/// settings are repeated.
std::vector<ReplacedReference> UsedIn(const std::vector<TrialRow>& rows,
                                      std::vector<ReplacedReference> replaced) {
  std::set<std::uint64_t> seeds;
  for (const TrialRow& row : rows) seeds.insert(row.seed.value_or(0));
  std::erase_if(replaced, [&](const ReplacedReference& one) {
    return !seeds.contains(one.used) && !seeds.contains(one.seed);
  });
  return replaced;
}

}  // namespace

bool IsRepeatedGrid(const experiment::Experiment& experiment) {
  return experiment.goal == experiment::Goal::kGrid &&
         experiment.falsify.repeat == Repeat::kEvery && FirstSeed(experiment).has_value();
}

std::optional<SweepResult> SweepGrid(const experiment::Experiment& experiment,
                                     const RunTrials& run) {
  const std::vector<experiment::Theta> settings =
      experiment::GridPoints(experiment.space.parameters);
  const bool is_repeated = IsRepeatedGrid(experiment);
  RepeatPlan plan(experiment.falsify, static_cast<int>(settings.size()),
                  experiment.gap.threshold_m);
  const int first = static_cast<int>(experiment.reference.trials.names.size());
  std::vector<std::vector<TrialRow>> rows(settings.size());
  std::vector<int> wanted(settings.size(), first);
  while (true) {
    std::vector<TrialRequest> requests;
    for (size_t i = 0; i < settings.size(); ++i) {
      for (TrialRequest& request : FurtherTrials(experiment, settings[i], TrialKind::kComparison,
                                                 static_cast<int>(rows[i].size()), wanted[i])) {
        requests.push_back(std::move(request));
      }
    }
    if (requests.empty()) break;
    std::optional<std::vector<TrialRow>> done = run(std::move(requests));
    if (!done) return std::nullopt;
    auto next = std::make_move_iterator(done->begin());
    for (size_t i = 0; i < settings.size(); ++i) {
      rows[i].insert(rows[i].end(), next, next + wanted[i]);
      next += wanted[i];
    }
    if (!is_repeated) break;
    wanted = plan.More({rows.begin(), rows.end()});
  }
  SweepResult result = EmptyResult(experiment);
  for (std::vector<TrialRow>& of_setting : rows) {
    std::move(of_setting.begin(), of_setting.end(), std::back_inserter(result.rows));
  }
  Summarise(result);
  return result;
}

std::optional<SweepResult> Sweep(Evaluator& evaluator, const RunTrials& run,
                                 const MayStart& may_start, const ReferenceWatch& references) {
  std::optional<std::vector<ReplacedReference>> replaced = evaluator.CheckReferences(references);
  if (!replaced) return std::nullopt;
  std::optional<SweepResult> result = RunGoal(evaluator.experiment(), run, may_start);
  if (!result) return result;
  bool is_stopped = false;
  const ReferenceProgress known{.arrived = 0, .seeds = 0};
  const auto go_on = [&] { return !(is_stopped = is_stopped || !references.go_on(known)); };
  for (SettingResult& setting : result->settings) {
    setting.noise_floor_m = evaluator.NoiseFloor_m(setting.theta, go_on);
    if (is_stopped) return std::nullopt;
  }
  result->replaced = UsedIn(result->rows, std::move(*replaced));
  return result;
}

}  // namespace rift::sweep
