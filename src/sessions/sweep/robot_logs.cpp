#include "robot_logs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "rift/files/files.hpp"
#include "rift/report/json/json.hpp"
#include "rift/sweep/falsify/settings.hpp"

namespace rift::sessions {
namespace {

namespace fs = std::filesystem;

/// Folders without a gap between them, as drives are made.
int CountDrives(const fs::path& sweep, int number) {
  int trials = 0;
  while (fs::exists(SuggestedDrive(sweep, number, trials + 1) / "trajectory.csv")) ++trials;
  return trials;
}

trial::Outcome OutcomeOf(const fs::path& drive) {
  const fs::path file = drive / "summary.json";
  const std::string summary = files::ReadFile(file);
  if (const auto outcome = report::DriveOutcome(summary)) return *outcome;
  throw std::invalid_argument(
      fmt::format("{}: {}: a drive that was not ended properly cannot be judged; move {} away",
                  file.string(), report::DriveEnding(summary), drive.string()));
}

/// The whole setting of a suggested experiment: what a person does not set is as the experiment
/// has it.
experiment::Theta ThetaOf(const experiment::Experiment& experiment,
                          const SuggestedExperiment& suggested) {
  experiment::Theta theta = experiment::NominalTheta(experiment);
  const std::vector<experiment::Parameter>& all = experiment.space.parameters;
  for (size_t i = 0; i < suggested.values.size(); ++i) {
    const auto found = std::find_if(all.begin(), all.end(), [&](const auto& parameter) {
      return parameter.key == suggested.parameters[i].key;
    });
    theta[static_cast<size_t>(found - all.begin())] = suggested.values[i];
  }
  return theta;
}

}  // namespace

std::vector<sweep::RobotTrials> TakeRobotLogs(const fs::path& folder, sweep::Evaluator& evaluator) {
  const experiment::Experiment& experiment = evaluator.experiment();
  std::vector<sweep::RobotTrials> all;
  // Parameters of recorded logs are names in their paths, which no drive can set.
  if (experiment.candidate.kind == experiment::CandidateKind::kLogs) return all;
  for (const SuggestedExperiment& suggested : ReadSuggested(folder, experiment)) {
    sweep::RobotTrials driven{.values = suggested.values,
                              .is_predicted_to_fail = suggested.is_predicted_to_fail};
    const int drives = CountDrives(folder, suggested.number);
    for (int i = 0; i < drives; ++i) {
      const fs::path drive = SuggestedDrive(folder, suggested.number, i + 1);
      const sweep::TrialRow row =
          evaluator.EvaluateDriven({.theta = ThetaOf(experiment, suggested),
                                    .trial = std::to_string(i + 1),
                                    .seed = experiment.seed + static_cast<std::uint64_t>(i)},
                                   (drive / "trajectory.csv").string(), OutcomeOf(drive));
      if (!row.Tells()) continue;
      ++driven.trials;
      driven.failures += row.falsified;
    }
    if (drives > 0) all.push_back(std::move(driven));
  }
  return all;
}

bool SaveSuggested(const fs::path& folder, const experiment::Experiment& experiment,
                   const sweep::SweepResult& result, const sweep::Suggestions& suggestions) {
  if (experiment.candidate.kind == experiment::CandidateKind::kLogs) return false;
  std::vector<SuggestedExperiment> all = ReadSuggested(folder, experiment);
  while (!all.empty() && CountDrives(folder, all.back().number) == 0) all.pop_back();
  for (const sweep::Suggestion& suggestion : suggestions.list) {
    const auto known = std::find_if(all.begin(), all.end(), [&](const auto& before) {
      return sweep::IsSameSetting(before.values, suggestion.values);
    });
    if (known != all.end()) {
      known->repeats = CountDrives(folder, known->number) + suggestion.repeats;
      continue;
    }
    SuggestedExperiment next{.number = static_cast<int>(all.size()) + 1,
                             .values = suggestion.values,
                             .repeats = suggestion.repeats,
                             .is_predicted_to_fail = suggestion.is_predicted_to_fail,
                             .why = suggestion.sentence};
    for (const int i : suggestions.settable) next.parameters.push_back(result.parameters[i]);
    all.push_back(std::move(next));
  }
  files::WriteFile(SuggestedFile(folder), WriteSuggested(all));
  return true;
}

}  // namespace rift::sessions
