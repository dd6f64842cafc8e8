#include "rift/sweep/falsify/grid.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <stdexcept>

#include "rift/experiment/parameter.hpp"
#include "rift/experiment/path_template.hpp"
#include "rift/sweep/falsify/labels.hpp"
#include "rift/sweep/falsify/summary.hpp"

namespace rift::sweep {
std::vector<TrialRequest> TrialsAt(const Experiment& experiment, const experiment::Theta& theta,
                                   int repeat) {
  std::vector<TrialRequest> requests;
  const size_t first = plan.trials.size() * static_cast<size_t>(repeat);
  for (size_t i = 0; i < plan.trials.size(); ++i) {
    TrialRequest request{.theta = theta, .trial = plan.trials[i]};
    if (plan.seed) request.seed = *plan.seed + first + i;
    requests.push_back(std::move(request));
  }
  return requests;
}

SweepResult EmptyResult(const Experiment& experiment) {
  SweepResult result;
  result.name = plan.name;
  result.candidate_kind = plan.candidate_kind;
  result.reference_kind = plan.reference_kind;
  result.gap = plan.gap;
  result.tag_offset_m = plan.tag_offset_m;
  result.parameters = plan.parameters;
  return result;
}

void Conclude(SweepResult& result, const NoiseFloor& noise_floor_m) {
  Summarise(result);
  for (SettingResult& setting : result.settings) {
    setting.noise_floor_m = noise_floor_m(setting.theta);
  }
}

std::optional<SweepResult> SweepGrid(const Experiment& experiment, const RunTrials& run,
                                     const NoiseFloor& noise_floor_m) {
  std::vector<TrialRequest> requests;
  for (const experiment::Theta& theta : experiment::GridPoints(plan.parameters)) {
    for (TrialRequest& request : TrialsAt(plan, theta)) requests.push_back(std::move(request));
  }
  std::optional<std::vector<TrialRow>> rows = run(std::move(requests));
  if (!rows) return std::nullopt;
  SweepResult result = EmptyResult(plan);
  result.rows = std::move(*rows);
  Conclude(result, noise_floor_m);
  return result;
}

}  // namespace rift::sweep
