#include "rift/sweep/falsify/grid.hpp"

#include <iterator>
#include <span>

#include "rift/statistics/hash.hpp"
#include "rift/statistics/random.hpp"
#include "rift/sweep/falsify/result.hpp"
#include "rift/sweep/falsify/verdict.hpp"
#include "rift/yaml/enum_name.hpp"

namespace rift::sweep {

using experiment::Experiment;

std::optional<std::uint64_t> FirstSeed(const Experiment& experiment) {
  if (experiment.candidate.kind == experiment::CandidateKind::kLogs) return std::nullopt;
  return experiment.seed;
}

std::uint64_t FreshSeed(std::uint64_t seed, std::uint64_t stream) {
  return statistics::SeedOfStream(seed, stream) >> 33;
}

namespace {

std::uint64_t FirstSeedAt(const Experiment& experiment, const experiment::Theta& theta,
                          TrialKind kind) {
  if (kind == TrialKind::kComparison) return experiment.seed;
  const std::string key = SettingKey(experiment.space.parameters, theta);
  return FreshSeed(experiment.seed, statistics::Hash64(std::as_bytes(std::span(key))));
}

}  // namespace

std::vector<TrialRequest> FurtherTrials(const Experiment& experiment,
                                        const experiment::Theta& theta, TrialKind kind, int before,
                                        int count) {
  const std::vector<std::string>& trials = experiment.reference.trials.names;
  const bool is_simulated = FirstSeed(experiment).has_value();
  std::vector<TrialRequest> requests;
  for (int i = before; i < before + count; ++i) {
    TrialRequest request{.theta = theta,
                         .trial = trials[static_cast<size_t>(i) % trials.size()],
                         .is_random_draw = kind == TrialKind::kRandomDraw};
    if (is_simulated)
      request.seed = FirstSeedAt(experiment, theta, kind) + static_cast<std::uint64_t>(i);
    requests.push_back(std::move(request));
  }
  return requests;
}

std::vector<TrialRequest> TrialsAt(const Experiment& experiment, const experiment::Theta& theta,
                                   TrialKind kind) {
  return FurtherTrials(experiment, theta, kind, 0,
                       static_cast<int>(experiment.reference.trials.names.size()));
}

SweepResult EmptyResult(const Experiment& experiment) {
  SweepResult result;
  result.name = experiment.name;
  result.candidate_kind = yaml::NameOf(experiment.candidate.kind);
  result.reference_kind = yaml::NameOf(experiment.reference.kind);
  result.gap = experiment.gap;
  result.judged_by = experiment.falsify;
  result.tag_offset_m = experiment.reference.tag_offset_m;
  result.parameters = experiment.space.parameters;
  return result;
}

std::optional<SweepResult> SweepGrid(const Experiment& experiment, const RunTrials& run) {
  const std::vector<experiment::Theta> settings =
      experiment::GridPoints(experiment.space.parameters);
  const bool is_repeated =
      experiment.falsify.repeat == Repeat::kEvery && FirstSeed(experiment).has_value();
  const RepeatPlan plan(experiment.falsify, static_cast<int>(settings.size()),
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

}  // namespace rift::sweep
