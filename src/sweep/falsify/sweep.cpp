#include "rift/sweep/falsify/sweep.hpp"

#include <stdexcept>

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

}  // namespace

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
  result->replaced = std::move(*replaced);
  return result;
}

}  // namespace rift::sweep
