#include "sweep_likeness.hpp"

#include <algorithm>
#include <set>

#include "rift/experiment/parameter.hpp"
#include "rift/sweep/falsify/labels.hpp"

namespace rift::commands {
namespace {

using sweep::RepeatedTrial;
using sweep::TrialStatus;

struct Labelled {
  std::string level;
  RepeatedTrial trial;
};

bool HasRepeatedLogs(const experiment::Experiment& experiment) {
  const auto& parameters = experiment.space.parameters;
  return experiment.reference.kind == experiment::ReferenceKind::kLogs &&
         experiment.reference.trials.names.size() > 1 &&
         std::none_of(parameters.begin(), parameters.end(),
                      [](const experiment::Parameter& axis) { return axis.IsContinuous(); });
}

/// The trials of one setting. A candidate log that serves all repeats is one run, not several.
void AddSetting(const experiment::Experiment& experiment, const experiment::Theta& theta,
                SweepSources& sources, std::vector<Labelled>& trials) {
  const bool is_simulated = experiment.candidate.kind == experiment::CandidateKind::kSimulation;
  const experiment::Experiment at =
      is_simulated ? experiment::ExperimentAt(experiment, theta) : experiment;
  std::set<std::string> logs;
  for (const sweep::TrialRequest& request : sweep::TrialsAt(sources.Plan(), theta)) {
    const sweep::Recording real = sources.Reference(request);
    if (real.status != TrialStatus::kOk) continue;
    Labelled labelled{sweep::MainLevel(experiment.space.parameters, theta),
                      {.setting = sweep::SettingKey(theta),
                       .real = real.trajectory,
                       .waypoints = at.waypoints,
                       .control = at.control}};
    sweep::Recording run = sources.Candidate(request, real);
    const bool is_new = is_simulated || logs.insert(run.source).second;
    if (run.status != TrialStatus::kOk) {
      ++labelled.trial.failed_runs;
    } else if (is_new) {
      labelled.trial.runs.push_back(std::move(run.trajectory));
    }
    trials.push_back(std::move(labelled));
  }
}

}  // namespace

std::vector<sweep::GroupLikeness> MeasureSweepLikeness(const experiment::Experiment& experiment,
                                                       SweepSources& sources) {
  if (!HasRepeatedLogs(experiment)) return {};
  std::vector<Labelled> trials;
  for (const experiment::Theta& theta : experiment::GridPoints(experiment.space.parameters)) {
    AddSetting(experiment, theta, sources, trials);
  }
  std::vector<std::string> levels;
  for (const Labelled& trial : trials) {
    if (std::find(levels.begin(), levels.end(), trial.level) == levels.end()) {
      levels.push_back(trial.level);
    }
  }
  levels.push_back("all");
  const bool is_matched = experiment.start == experiment::Start::kReference;
  std::vector<sweep::GroupLikeness> rows;
  for (const std::string& level : levels) {
    const bool is_all = &level == &levels.back();
    std::vector<RepeatedTrial> group;
    for (const Labelled& trial : trials) {
      if (is_all || trial.level == level) group.push_back(trial.trial);
    }
    std::mt19937_64 generator(experiment.seed);
    rows.push_back({level, sweep::MeasureDriveLikeness(group, is_matched, experiment.gap,
                                                       experiment.likeness, generator)});
  }
  return rows;
}

}  // namespace rift::commands
