#include "rift/experiment/experiment.hpp"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <set>

#include "calibrate_keys.hpp"
#include "ensemble_keys.hpp"
#include "rift/experiment/parameter.hpp"
#include "rift/experiment/program_parameters.hpp"
#include "rift/experiment/settable.hpp"
#include "rift/experiment/space_yaml.hpp"
#include "rift/limits/limits.hpp"
#include "rift/yaml/bind.hpp"
#include "rift/yaml/describe.hpp"
#include "rift/yaml/node.hpp"
#include "rift/yaml/utf8.hpp"
#include "rift/yaml/write.hpp"
#include "setting_check.hpp"

namespace rift::experiment {
namespace {

/// A resolved experiment is written into a run folder, so its paths must not depend on where a
/// file or a shell stood.
void MakeAbsolute(PathTemplate& path) {
  if (path.text.empty()) return;
  path.text = std::filesystem::absolute(path.text).lexically_normal().string();
}

/// Keys that a simulated trial reads; an axis of any other would repeat the same rows.
void RequireEffect(const Parameter& parameter) {
  for (const std::string_view block :
       {"control.", "trial.", "simulation.", "waypoints", "program."}) {
    if (parameter.key.starts_with(block)) return;
  }
  throw yaml::Error(fmt::format("{} does not change a simulated trial; {}", parameter.key,
                                parameter.key == "seed"
                                    ? "for repeats set reference.trials"
                                    : "vary keys of control, trial, program or simulation"));
}

std::set<std::string> WholeNumberKeys(const Experiment& experiment) {
  std::set<std::string> keys;
  for (const yaml::KeyInfo& key : yaml::Describe(experiment)) {
    if (key.type.starts_with("whole number")) keys.insert(key.key);
  }
  return keys;
}

/// The picture of a heightfield, like every path of a file, is relative to that file.
void ResolveImages(yaml::Node& tree) {
  yaml::Node* node = &tree;
  for (const char* key : {"simulation", "terrain", "surfaces"}) {
    yaml::Node::Entry* entry = node->Find(key);
    if (entry == nullptr) return;
    node = &entry->value;
  }
  for (yaml::Node::Entry& surface : node->entries) {
    yaml::Node::Entry* image = surface.value.Find("image");
    if (image == nullptr || !image->value.IsScalar() || image->value.text.empty()) continue;
    PathTemplate path = yaml::Hook<PathTemplate>::FromNode(image->value);
    MakeAbsolute(path);
    image->value.text = path.text;
    image->value.quoted = true;
  }
}

bool IsImage(const std::string& key) {
  return key.starts_with("simulation.terrain.surfaces.") && key.ends_with(".image");
}

/// The same of the pictures that a space varies. `tree` is what the space was read from.
void ResolveImages(const yaml::Node& tree, Space& space) {
  const yaml::Node::Entry* block = tree.Find("space");
  if (block == nullptr) return;
  const std::vector<yaml::FlatEntry> axes = yaml::Flatten(block->value);
  for (size_t i = 0; i < axes.size(); ++i) {
    Parameter& parameter = space.parameters[i];
    if (!IsImage(parameter.key)) continue;
    const yaml::Node::Entry* values = axes[i].value->Find("values");
    const std::vector<yaml::Node>& items = (values ? values->value : *axes[i].value).items;
    for (size_t j = 0; j < items.size(); ++j) {
      PathTemplate path = yaml::Hook<PathTemplate>::FromNode(items[j]);
      MakeAbsolute(path);
      parameter.levels[j] = {path.text, std::nullopt};
    }
  }
}

void RequireTaken(const Experiment& experiment, const std::string& path) {
  using limits::Amount;
  const auto require = [&](Amount amount, double count) { limits::Require(amount, count, path); };
  require(Amount::kSamples, experiment.gap.samples);
  require(Amount::kWaypoints, static_cast<double>(experiment.waypoints.size()));
  if (experiment.goal != Goal::kGrid) return;
  auto trials = static_cast<double>(experiment.reference.trials.names.size());
  for (const Parameter& parameter : experiment.space.parameters) {
    if (!parameter.IsContinuous()) trials *= static_cast<double>(parameter.levels.size());
  }
  require(Amount::kGridTrials, trials);
}

/// Names stand in the lines of tables and sentences.
void RequireOneLineNames(const Experiment& experiment, const std::string& path) {
  const auto require = [&path](const char* key, const std::string& name) {
    if (name.find_first_of("\n\r") == name.npos) return;
    throw yaml::Error(fmt::format("{}: {} is '{}': names have no line breaks", path, key, name));
  };
  require("name", experiment.name);
  for (const control::Waypoint& waypoint : experiment.waypoints) {
    require("the name of a waypoint", waypoint.name);
  }
  for (const std::string& trial : experiment.reference.trials.names) {
    require("a trial of reference.trials", trial);
  }
}

/// A saved experiment is YAML, which is UTF-8. Its text is, but a folder may be called otherwise.
void RequireUtf8Name(const std::string& path, std::string_view key, const std::string& name) {
  if (yaml::IsUtf8(name)) return;
  throw yaml::Error(
      fmt::format("{}: {} is '{}', and that name is not UTF-8, which a saved run needs: rename the "
                  "folder or the file",
                  path, key, name));
}

void RequireUtf8Names(const Experiment& experiment, const std::string& path) {
  const auto require = [&path](std::string_view key, const std::string& name) {
    RequireUtf8Name(path, key, name);
  };
  require("name", experiment.name);
  require("candidate.path", experiment.candidate.path.text);
  require("reference.path", experiment.reference.path.text);
  for (const std::string& word : experiment.candidate.run.words) require("candidate.run", word);
  for (const std::string& word : experiment.reference.run.words) require("reference.run", word);
  for (const auto& [name, surface] : experiment.simulation.terrain.surfaces) {
    require(fmt::format("simulation.terrain.surfaces.{}.image", name), surface.image);
  }
}

/// The same of the pictures that a space varies.
void RequireUtf8Images(const Space& space, const std::string& path) {
  for (const Parameter& parameter : space.parameters) {
    if (!IsImage(parameter.key)) continue;
    for (const ParameterValue& level : parameter.levels) {
      RequireUtf8Name(path, "space." + parameter.key, level.text);
    }
  }
}

/// A range of a key that holds whole numbers is one of whole numbers, said or not.
void RequireWhole(Parameter& parameter) {
  parameter.is_integer = true;
  const bool is_whole = parameter.min == std::floor(parameter.min) &&
                        parameter.max == std::floor(parameter.max) && !parameter.is_logarithmic;
  if (!is_whole) {
    throw yaml::Error(fmt::format(
        "{} holds whole numbers: its range needs whole bounds and a linear scale", parameter.key));
  }
  if (!parameter.step || *parameter.step == std::floor(*parameter.step)) return;
  throw yaml::Error(fmt::format("{} holds whole numbers: its step is {:g}, and it must be whole",
                                parameter.key, *parameter.step));
}

/// A simulated parameter is any key of the experiment, by its full name or a short one that is
/// unique.
void ResolveSpace(Experiment& experiment) {
  const std::vector<std::string> keys = yaml::ListKeys(experiment);
  const std::set<std::string> whole_keys = WholeNumberKeys(experiment);
  for (Parameter& parameter : experiment.space.parameters) {
    try {
      parameter.key = yaml::ResolveKey(parameter.key, keys);
      RequireEffect(parameter);
      const bool is_whole = parameter.IsContinuous() && whole_keys.contains(parameter.key);
      if (is_whole) RequireWhole(parameter);
    } catch (const yaml::Error& unknown) {
      throw yaml::Error(fmt::format("{}: space: {}", parameter.origin, unknown.what()));
    }
  }
  if (experiment.goal != Goal::kFalsify) CheckGrid(experiment.space.parameters);
  TrySpace(experiment);
}

}  // namespace

Experiment ExperimentAt(const Experiment& experiment, const std::vector<ParameterValue>& theta) {
  if (experiment.candidate.kind == CandidateKind::kProgram) return experiment;  // names of its own
  Experiment at = experiment;
  yaml::SetValues(at, ValuesAt(experiment.space.parameters, theta));
  return at;
}

control::Task TaskOf(const Experiment& experiment) {
  if (experiment.program.segments.empty()) {
    control::CheckWaypoints(experiment.waypoints);
    return experiment.waypoints;
  }
  if (experiment.waypoints.size() > 1) {
    throw std::invalid_argument(
        fmt::format("{} waypoints beside a program: it starts at the first and makes its own "
                    "ends, leave the others out",
                    experiment.waypoints.size()));
  }
  geometry::Pose2 start;
  if (!experiment.waypoints.empty()) {
    const control::Waypoint& first = experiment.waypoints.front();
    start = {first.x_m, first.y_m, geometry::RadFromDeg(first.heading_deg.value_or(0.0))};
  }
  const control::Program program(experiment.program, experiment.hardware.odometry.drive, start);
  const double needed_s =
      experiment.trial.settle_s + program.Duration_s() + experiment.program.rest_s;
  if (needed_s < experiment.trial.timeout_s) return program;
  throw std::invalid_argument(
      fmt::format("the program takes {:.1f} s with settling and rest, and trial.timeout_s is {:g}: "
                  "raise it",
                  needed_s, experiment.trial.timeout_s));
}

namespace {

/// Of a parameter that is no key: what its range says, else the middle of that; else the first of
/// its values.
ParameterValue OwnNominal(const Parameter& parameter) {
  if (!parameter.IsContinuous()) return parameter.levels.front();
  if (parameter.nominal) return NumberValue(*parameter.nominal);
  const double middle = parameter.is_logarithmic ? std::sqrt(parameter.min * parameter.max)
                                                 : 0.5 * (parameter.min + parameter.max);
  return NumberValue(parameter.is_integer ? std::floor(middle) : middle);
}

/// The parameters of a program are names of its own, which its arguments or its JSON hold.
void CheckProgramSpace(const Experiment& experiment) {
  if (experiment.goal != Goal::kFalsify) CheckGrid(experiment.space.parameters);
}

/// Only a program has parameters whose values at rest the experiment does not hold already.
void RefuseNominal(const Experiment& experiment) {
  for (const Parameter& parameter : experiment.space.parameters) {
    if (!parameter.nominal) continue;
    throw yaml::Error(fmt::format(
        "{}: space.{}: nominal is of a program's parameters: here the key {} has the value",
        parameter.origin, parameter.key, parameter.key));
  }
}

}  // namespace

std::vector<Parameter> ProgramParameters(const Experiment& experiment) {
  std::vector<Parameter> parameters = experiment.space.parameters;
  const bool is_fitted =
      experiment.goal == Goal::kCalibrate && experiment.candidate.kind == CandidateKind::kProgram;
  if (!is_fitted) return parameters;
  for (const FreeParameter& free : experiment.calibrate.fit.list) {
    parameters.push_back({.key = free.key,
                          .min = free.min,
                          .max = free.max,
                          .nominal = free.start,
                          .origin = free.origin});
  }
  return parameters;
}

Theta WithFitted(Theta theta, const std::vector<double>& values) {
  for (const double value : values) theta.push_back(NumberValue(value));
  return theta;
}

Theta NominalTheta(const Experiment& experiment) {
  Theta theta;
  if (experiment.candidate.kind == CandidateKind::kProgram) {
    for (const Parameter& parameter : ProgramParameters(experiment)) {
      theta.push_back(OwnNominal(parameter));
    }
    return theta;
  }
  for (const Parameter& parameter : experiment.space.parameters) {
    theta.push_back(ValueFromNode(yaml::GetValue(experiment, parameter.key), parameter.key));
  }
  return theta;
}

Experiment CalibratedAt(const Experiment& experiment, const std::vector<double>& values) {
  std::vector<yaml::KeyValue> pairs;
  for (size_t i = 0; i < values.size(); ++i) {
    const FreeParameter& free = experiment.calibrate.fit.list[i];
    pairs.push_back(ValueOfKey(free.key, NumberValue(values[i]), {free.origin}));
  }
  Experiment at = experiment;
  yaml::SetValues(at, pairs);
  at.ensemble = {};
  return at;
}

bool KeepsRules(const Experiment& experiment, const std::vector<double>& values,
                const std::vector<Theta>& settings) {
  try {
    const Experiment at = CalibratedAt(experiment, values);
    for (const Theta& theta : settings) ExperimentAt(at, theta);
  } catch (const yaml::Error&) {  // which rule is nobody's matter here
    return false;
  }
  return true;
}

Experiment LoadExperiment(const std::string& path, const std::vector<std::string>& overrides,
                          const yaml::FileReader& read) {
  yaml::Node tree = yaml::Load(path, read);
  for (const std::string& assignment : overrides)
    yaml::Merge(tree, yaml::ParseOverride(assignment));
  Experiment experiment;
  experiment.name = std::filesystem::path(path).stem().string();
  ResolveImages(tree);
  yaml::Bind(tree, experiment);
  RequireTaken(experiment, path);
  RequireOneLineNames(experiment, path);
  MakeAbsolute(experiment.candidate.path);
  MakeAbsolute(experiment.reference.path);
  RequireUtf8Names(experiment, path);
  if (experiment.candidate.kind == CandidateKind::kSimulation) {
    ResolveSpace(experiment);
    ResolveImages(tree, experiment.space);
    RequireUtf8Images(experiment.space, path);
  }
  if (experiment.candidate.kind == CandidateKind::kProgram) CheckProgramSpace(experiment);
  if (experiment.candidate.kind != CandidateKind::kProgram) RefuseNominal(experiment);
  if (experiment.goal == Goal::kCalibrate) ResolveCalibrate(experiment, path);
  ResolveEnsemble(experiment, tree);
  return experiment;
}

namespace {

std::string SettableText(const std::string& key) {
  const std::optional<Settable> settable = FindSettable(key);
  if (!settable || key.find('.') == key.npos) return "";
  if (!(settable->step > 0.0)) return " (a person can set it on the robot)";
  return fmt::format(" (a person can set it on the robot, in steps of {:g})", settable->step);
}

}  // namespace

std::string DescribeKeys() {
  std::string text;
  for (const yaml::KeyInfo& key : yaml::Describe<Experiment>()) {
    const std::string standard =
        key.default_text.empty() ? "" : fmt::format(" [{}]", key.default_text);
    text += fmt::format("{}: {}{}\n    {}{}\n", key.key, key.type, standard, key.help,
                        SettableText(key.key));
  }
  return text;
}

std::map<std::string, std::string> FlatValues(const Experiment& experiment) {
  std::map<std::string, std::string> values;
  const yaml::Node tree = yaml::ToNode(experiment);
  for (const yaml::FlatEntry& entry : yaml::Flatten(tree)) {
    std::string line;
    for (const char c : yaml::Emit(*entry.value)) {
      const bool is_gap = c == '\n' || c == ' ';
      if (!is_gap)
        line += c;
      else if (!line.empty() && line.back() != ' ')
        line += ' ';
    }
    if (line.ends_with(' ')) line.pop_back();
    values[entry.key] = line;
  }
  return values;
}

std::string WriteExperiment(const Experiment& experiment) {
  return yaml::Emit(yaml::ToNode(experiment));
}

}  // namespace rift::experiment
