#include "experiment_sides.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "rift/experiment/parameter.hpp"
#include "rift/experiment/path_template.hpp"
#include "rift/sweep/falsify/settings.hpp"
#include "rift/yaml/enum_name.hpp"
#include "rift/yaml/node.hpp"

namespace rift::sweep {
namespace {

using experiment::CandidateKind;
using experiment::ReferenceKind;

bool Has(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

std::string InBraces(const std::set<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "{" : ", {") + name + "}";
  return text.empty() ? "nothing" : text;
}

/// One log under two settings would be counted twice.
void RefuseSharedLogs(const experiment::Experiment& experiment) {
  const std::vector<experiment::Parameter>& parameters = experiment.space.parameters;
  const auto is_continuous = [](const experiment::Parameter& parameter) {
    return parameter.IsContinuous();
  };
  if (std::any_of(parameters.begin(), parameters.end(), is_continuous)) return;
  std::map<std::pair<std::string, std::string>, experiment::Theta> seen;
  for (const experiment::Theta& theta : experiment::GridPoints(parameters)) {
    const std::string& trial = experiment.reference.trials.names.front();
    const auto fill = [&](const std::string& path) {
      return experiment::FillTemplate(path, parameters, theta, trial);
    };
    const auto [first, is_new] = seen.try_emplace(
        {fill(experiment.candidate.path.text), fill(experiment.reference.path.text)}, theta);
    if (is_new) continue;
    throw std::invalid_argument(fmt::format(
        "two settings name the same logs, {} and {}: give the path templates more digits ({})",
        SettingText(parameters, first->second), SettingText(parameters, theta),
        first->first.second));
  }
}

void RequirePath(const experiment::PathTemplate& path, const std::string& key) {
  if (!path.text.empty()) return;
  throw std::invalid_argument(fmt::format(
      "{} is missing: name the logs, such as {}: logs/{{surface}}_{{trial}}.csv", key, key));
}

/// What a template names is said now, before a folder is made.
void CheckTemplate(const experiment::Experiment& experiment, const experiment::PathTemplate& path,
                   const std::string& key) {
  experiment::Theta first;
  for (const experiment::Parameter& parameter : experiment.space.parameters) {
    first.push_back(parameter.levels.empty() ? experiment::NumberValue(parameter.min)
                                             : parameter.levels.front());
  }
  try {
    experiment::FillTemplate(path.text, experiment.space.parameters, first,
                             experiment.reference.trials.names.front());
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(fmt::format("{}: {}", key, error.what()));
  }
}

/// A gap in space needs heights on both sides, and has nothing to do with headings in the plane.
void CheckDimension(const experiment::Experiment& experiment) {
  if (!experiment.gap.IsInSpace()) return;
  const auto refuse = [](const std::string& why) {
    throw std::invalid_argument("gap.dimension is xyz, " + why);
  };
  if (experiment.candidate.kind == CandidateKind::kSimulation) {
    refuse(
        "and candidate.kind is simulation, a robot that drives on a floor: use logs or a program");
  }
  if (experiment.reference.kind == ReferenceKind::kPath) {
    refuse("and reference.kind is path, whose waypoints have no height: use logs or a program");
  }
  if (experiment.objective == experiment::Objective::kOdometry) {
    refuse("and objective is odometry, which is of wheels on a floor: leave one of them out");
  }
  if (experiment.reference.tag_offset_m != 0.0) {
    refuse(
        fmt::format("and reference.tag_offset_m is {:g}, which moves a path along its yaw in the "
                    "plane: log the point that is to be compared, and leave it out",
                    experiment.reference.tag_offset_m));
  }
}

/// Which of objective, start, candidate and reference go together.
void CheckKinds(const experiment::Experiment& experiment) {
  const bool candidate_is_program = experiment.candidate.kind == CandidateKind::kProgram;
  const bool reference_is_logs = experiment.reference.kind == ReferenceKind::kLogs;
  const bool is_odometry = experiment.objective == experiment::Objective::kOdometry;
  const bool starts_as_reference = experiment.start == experiment::Start::kReference;
  if (candidate_is_program && is_odometry) {
    throw std::invalid_argument(
        "objective is odometry, and a program (candidate.kind) has no encoders for rift");
  }
  if (candidate_is_program && starts_as_reference) {
    throw std::invalid_argument(
        "start is reference, and candidate.kind is program: rift does not place somebody else's "
        "robot; leave start out");
  }
  if (is_odometry && reference_is_logs) {
    throw std::invalid_argument(
        "objective is odometry, which holds each run of the candidate against its own camera, and "
        "reference.kind is logs: name logs as candidate.path");
  }
  if (starts_as_reference && !reference_is_logs) {
    throw std::invalid_argument(fmt::format(
        "start is reference, and reference.kind is {}: only logs tell where the robot stood",
        yaml::NameOf(experiment.reference.kind)));
  }
}

}  // namespace

void CheckSides(const experiment::Experiment& experiment) {
  const bool candidate_is_logs = experiment.candidate.kind == CandidateKind::kLogs;
  const bool reference_is_logs = experiment.reference.kind == ReferenceKind::kLogs;
  if (candidate_is_logs) RequirePath(experiment.candidate.path, "candidate.path");
  if (reference_is_logs) RequirePath(experiment.reference.path, "reference.path");
  if (candidate_is_logs) CheckTemplate(experiment, experiment.candidate.path, "candidate.path");
  if (reference_is_logs) CheckTemplate(experiment, experiment.reference.path, "reference.path");
  if (candidate_is_logs && reference_is_logs) CheckPaths(experiment);
  CheckDimension(experiment);
  CheckKinds(experiment);
}

void CheckPaths(const experiment::Experiment& experiment) {
  std::vector<std::string> names = experiment::TemplateNames(experiment.candidate.path.text);
  const std::vector<std::string> more = experiment::TemplateNames(experiment.reference.path.text);
  names.insert(names.end(), more.begin(), more.end());
  for (const experiment::Parameter& parameter : experiment.space.parameters) {
    if (Has(names, parameter.Name())) continue;
    throw std::invalid_argument(fmt::format(
        "{}space.{} is in neither candidate.path nor reference.path as {{{}}}: they name {}",
        parameter.origin.empty() ? "" : parameter.origin + ": ", parameter.key, parameter.Name(),
        InBraces({names.begin(), names.end()})));
  }
  if (experiment.reference.trials.names.size() > 1 && !Has(names, "trial")) {
    throw std::invalid_argument(
        "reference.trials asks for repeats, and no path names {trial} to tell them apart");
  }
  RefuseSharedLogs(experiment);
}

std::optional<std::string> WhyOtherDrive(const std::string& file, const std::string& text,
                                         const experiment::Experiment& asked) {
  std::map<std::string, std::string> driven;
  try {
    driven = experiment::FlatValues(
        experiment::LoadExperiment(file, {}, [&text](const std::string&) { return text; }));
  } catch (const std::exception& unreadable) {  // broken, or beyond a limit of inputs
    return unreadable.what();
  }
  for (const auto& [key, value] : experiment::FlatValues(asked)) {
    const bool is_of_drive = key.starts_with("waypoints") || key.starts_with("program.") ||
                             key.starts_with("control.") || key.starts_with("trial.");
    if (!is_of_drive || driven[key] == value) continue;
    return fmt::format("{}: {} is {}, and {} in this sweep", file, key, driven[key], value);
  }
  return std::nullopt;
}

}  // namespace rift::sweep
