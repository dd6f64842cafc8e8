#include "rift/sessions/drive/plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "rift/experiment/path_template.hpp"
#include "rift/sessions/drive/identification.hpp"
#include "rift/sessions/sweep/suggested.hpp"
#include "rift/sweep/falsify/result.hpp"
#include "rift/twin/options.hpp"

namespace rift::sessions {
namespace {

namespace fs = std::filesystem;
using experiment::Experiment;
using experiment::Parameter;

constexpr const char* kSurface = "simulation.terrain.surface";

std::size_t IndexOf(const std::vector<Parameter>& parameters, std::string_view key) {
  const auto is_meant = [key](const Parameter& parameter) { return parameter.key == key; };
  return static_cast<std::size_t>(std::find_if(parameters.begin(), parameters.end(), is_meant) -
                                  parameters.begin());
}

/// A robot on the floor is the same whatever the simulator's keys say.
void CheckDrivable(const Experiment& experiment) {
  if (experiment.candidate.kind != experiment::CandidateKind::kSimulation) {
    throw std::invalid_argument(fmt::format(
        "{}: candidate.kind is logs, and a grid is driven to be held against the simulator",
        experiment.name));
  }
  if (experiment.goal != experiment::Goal::kGrid) {
    throw std::invalid_argument(
        fmt::format("{}: only goal: grid has a table of settings to drive", experiment.name));
  }
  for (const Parameter& parameter : experiment.space.parameters) {
    if (parameter.key == kSurface || !parameter.key.starts_with("simulation.")) continue;
    throw std::invalid_argument(
        fmt::format("{}: {} changes the simulator and no robot: of simulation, a grid that is "
                    "driven may vary terrain.surface alone",
                    parameter.origin, parameter.key));
  }
}

/// "{surface}_v_min{v_min}_{trial}": words say what they are, numbers need their names.
std::string FolderTemplate(const std::vector<Parameter>& parameters) {
  std::string text;
  for (const Parameter& parameter : parameters) {
    text += fmt::format("{0}{{{1}}}_", parameter.IsCategorical() ? "" : parameter.Name(),
                        parameter.Name());
  }
  return text + "{trial}";
}

fs::path FolderOf(const fs::path& out, const std::string& folder_template,
                  const std::vector<Parameter>& parameters, const experiment::Theta& theta,
                  const std::string& trial) {
  const std::string name = experiment::FillTemplate(folder_template, parameters, theta, trial);
  if (name.find('/') == std::string::npos && !name.starts_with('.')) return out / name;
  throw std::invalid_argument(fmt::format(
      "'{}' is no folder name: name the trials and levels without '/' and a leading '.'", name));
}

/// The logs of the drives in the place of the truth, the simulator started where they did and with
/// the host that drove them.
Experiment SweepOf(Experiment experiment, const fs::path& out, const std::string& folder_template) {
  experiment.candidate = {};
  experiment.reference.kind = experiment::ReferenceKind::kLogs;
  experiment.reference.path.text =
      (fs::absolute(out).lexically_normal() / folder_template / "trajectory.csv").string();
  experiment.reference.format = trajectory::Format::kRift;
  experiment.reference.tag_offset_m = 0.0;
  experiment.start = experiment::Start::kReference;
  experiment.goal = experiment::Goal::kGrid;
  experiment.simulation = twin::WithRiftHost(std::move(experiment.simulation), experiment.twin);
  return experiment;
}

/// One drive under two settings would be counted twice, and the other never driven.
void RequireOwnFolder(const PlannedTrial& trial, std::map<fs::path, std::string>& label_of) {
  const auto [first, is_new] = label_of.emplace(trial.folder, trial.label);
  if (is_new) return;
  throw std::invalid_argument(
      fmt::format("{} would hold two drives, of {} and of {}: name levels or trials so that their "
                  "folders differ",
                  trial.folder.string(), first->second, trial.label));
}

SeriesPlan PlanOf(const Experiment& experiment, const fs::path& out,
                  const std::string& folder_template) {
  const std::vector<Parameter>& parameters = experiment.space.parameters;
  SeriesPlan plan{.parameters = parameters, .sweep = SweepOf(experiment, out, folder_template)};
  std::map<fs::path, std::string> label_of;
  for (const experiment::Theta& theta : experiment::GridPoints(parameters)) {
    const std::string setting = sweep::SettingText(parameters, theta);
    for (const std::string& trial : experiment.reference.trials.names) {
      plan.trials.push_back({theta, trial, experiment::ExperimentAt(experiment, theta),
                             FolderOf(out, folder_template, parameters, theta, trial),
                             fmt::format("{}, trial {}", setting, trial)});
      RequireOwnFolder(plan.trials.back(), label_of);
    }
  }
  return plan;
}

/// Floors take longest to change.
void PutFloorsFirst(SeriesPlan& plan, const std::vector<Parameter>& parameters) {
  const std::size_t surface = IndexOf(parameters, kSurface);
  if (surface == parameters.size() || plan.trials.empty()) return;
  plan.has_floors = true;
  const std::vector<experiment::ParameterValue>& levels = parameters[surface].levels;
  const auto rank = [&](const PlannedTrial& trial) {
    return std::find(levels.begin(), levels.end(), trial.theta[surface]) - levels.begin();
  };
  std::stable_sort(plan.trials.begin(), plan.trials.end(),
                   [&](const auto& a, const auto& b) { return rank(a) < rank(b); });
}

}  // namespace

SeriesPlan PlanGrid(const Experiment& loaded, const fs::path& out) {
  Experiment experiment = loaded;
  if (experiment.space.parameters.empty()) experiment.space = experiment::PaperSpace();
  CheckDrivable(experiment);
  const std::vector<Parameter>& parameters = experiment.space.parameters;
  SeriesPlan plan = PlanOf(experiment, out, FolderTemplate(parameters));
  PutFloorsFirst(plan, parameters);
  return plan;
}

// What one setting leaves out is as the experiment has it: the floor is laid for it all the same,
// and a scene command is told.
SeriesPlan PlanChosen(const Experiment& experiment, const std::vector<ChosenSetting>& settings) {
  SeriesPlan plan{.sweep = experiment, .sweeps_drives = false};
  const experiment::Theta nominal = experiment::NominalTheta(experiment);
  experiment::Theta own;
  for (std::size_t i = 0; i < experiment.space.parameters.size(); ++i) {
    const Parameter& parameter = experiment.space.parameters[i];
    const bool is_named =
        std::any_of(settings.begin(), settings.end(), [&](const ChosenSetting& one) {
          return IndexOf(one.parameters, parameter.key) < one.parameters.size();
        });
    if (!is_named) continue;
    plan.parameters.push_back(parameter);
    own.push_back(nominal[i]);
  }
  for (const ChosenSetting& one : settings) {
    experiment::Theta theta = own;
    for (std::size_t i = 0; i < one.values.size(); ++i) {
      theta[IndexOf(plan.parameters, one.parameters[i].key)] = one.values[i];
    }
    Experiment varied = experiment;
    varied.space.parameters = one.parameters;
    const Experiment at = experiment::ExperimentAt(varied, one.values);
    const std::string setting = sweep::SettingText(one.parameters, one.values);
    for (std::size_t i = 0; i < one.folders.size(); ++i) {
      const std::string trial = std::to_string(i + 1);
      plan.trials.push_back({theta, trial, at, one.folders[i],
                             fmt::format("{} ({}), trial {}", one.name, setting, trial)});
    }
  }
  PutFloorsFirst(plan, plan.parameters);
  return plan;
}

SeriesPlan PlanRepeats(const Experiment& loaded, int count, const fs::path& out) {
  Experiment experiment = loaded;
  experiment.space.parameters.clear();
  experiment.reference.trials.names.clear();
  for (int i = 1; i <= count; ++i) experiment.reference.trials.names.push_back(std::to_string(i));
  SeriesPlan plan = PlanOf(experiment, out, "{trial}");
  plan.parameters.clear();
  for (PlannedTrial& trial : plan.trials) trial.label = "trial " + trial.trial;
  // A sweep of the simulator over no space would be the paper's.
  plan.sweep.space.parameters = {
      {.key = kSurface, .levels = {{experiment.simulation.terrain.surface, std::nullopt}}}};
  return plan;
}

namespace {

/// What `rift sweep --suggest` wrote into the folder of its sweep.
SeriesPlan PlanSuggested(const Experiment& experiment, const fs::path& folder) {
  std::vector<ChosenSetting> settings;
  for (const SuggestedExperiment& one : ReadSuggested(folder, experiment)) {
    settings.push_back({fmt::format("experiment {}", one.number), one.parameters, one.values});
    for (int trial = 1; trial <= one.repeats; ++trial) {
      settings.back().folders.push_back(SuggestedDrive(folder, one.number, trial));
    }
  }
  if (!settings.empty()) return PlanChosen(experiment, settings);
  throw std::invalid_argument(fmt::format(
      "{} has no experiments to drive: rift sweep {} --out {} --suggest 3 writes them",
      SuggestedFile(folder).string(), (folder / "experiment.yaml").string(), folder.string()));
}

/// Read as `rift sweep` will read it: what it would refuse after the drives is refused before them.
void RequireSweepable(const Experiment& sweep, const fs::path& file) {
  experiment::LoadExperiment(
      file.string(), {}, [&](const std::string&) { return experiment::WriteExperiment(sweep); });
}

}  // namespace

SeriesPlan PlanSeries(const SeriesRequest& request, const Experiment& experiment,
                      const fs::path& out) {
  if (request.grid) return PlanGrid(experiment, out);
  if (!request.suggested.empty()) {
    const fs::path sweep = request.suggested;
    SeriesPlan plan = PlanSuggested(experiment, sweep);
    plan.next = fmt::format("what they confirm: rift sweep {} --out {}",
                            (sweep / "experiment.yaml").string(), sweep.string());
    return plan;
  }
  SeriesPlan plan = PlanRepeats(experiment, request.repeat.value_or(kIdentificationRuns), out);
  const std::string sweep = fmt::format("rift sweep {} --out {}", (out / "sweep.yaml").string(),
                                        (out / "sweep").string());
  plan.next = "against the simulator: " + sweep;
  if (!request.identify) return plan;
  plan.sweep = IdentificationFit(std::move(plan.sweep));
  RequireSweepable(plan.sweep, out / "sweep.yaml");
  plan.next = fmt::format("fit the simulated robot: {} --write-robot {}", sweep,
                          (out / "robot.yaml").string());
  return plan;
}

}  // namespace rift::sessions
