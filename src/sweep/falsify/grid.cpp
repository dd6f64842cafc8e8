#include "rift/sweep/falsify/grid.hpp"

#include "rift/sweep/falsify/result.hpp"
#include "rift/yaml/enum_name.hpp"

namespace rift::sweep {

using experiment::Experiment;

std::optional<std::uint64_t> FirstSeed(const Experiment& experiment) {
  if (experiment.candidate.kind == experiment::CandidateKind::kLogs) return std::nullopt;
  return experiment.seed;
}

std::vector<TrialRequest> TrialsAt(const Experiment& experiment, const experiment::Theta& theta,
                                   int repeat) {
  const std::vector<std::string>& trials = experiment.reference.trials.names;
  const std::optional<std::uint64_t> first_seed = FirstSeed(experiment);
  const size_t first = trials.size() * static_cast<size_t>(repeat);
  std::vector<TrialRequest> requests;
  for (size_t i = 0; i < trials.size(); ++i) {
    TrialRequest request{.theta = theta, .trial = trials[i]};
    if (first_seed) request.seed = *first_seed + first + i;
    requests.push_back(std::move(request));
  }
  return requests;
}

SweepResult EmptyResult(const Experiment& experiment) {
  SweepResult result;
  result.name = experiment.name;
  result.candidate_kind = yaml::NameOf(experiment.candidate.kind);
  result.reference_kind = yaml::NameOf(experiment.reference.kind);
  result.gap = experiment.gap;
  result.tag_offset_m = experiment.reference.tag_offset_m;
  result.parameters = experiment.space.parameters;
  return result;
}

std::optional<SweepResult> SweepGrid(const Experiment& experiment, const RunTrials& run) {
  std::vector<TrialRequest> requests;
  for (const experiment::Theta& theta : experiment::GridPoints(experiment.space.parameters)) {
    for (TrialRequest& request : TrialsAt(experiment, theta)) {
      requests.push_back(std::move(request));
    }
  }
  std::optional<std::vector<TrialRow>> rows = run(std::move(requests));
  if (!rows) return std::nullopt;
  SweepResult result = EmptyResult(experiment);
  result.rows = std::move(*rows);
  Summarise(result);
  return result;
}

}  // namespace rift::sweep
