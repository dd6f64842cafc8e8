#include "rift/config/experiment.hpp"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <set>

#include "calibrate_keys.hpp"
#include "rift/config/bind.hpp"
#include "rift/config/describe.hpp"
#include "rift/config/error.hpp"
#include "rift/config/set_value.hpp"
#include "rift/config/sweep_hooks.hpp"
#include "rift/config/tree.hpp"
#include "rift/config/write.hpp"
#include "rift/sweep/grid.hpp"
#include "rift/sweep/grid_sweep.hpp"

namespace rift::config {
namespace {

/// A resolved experiment is written into a run folder, so its paths must not depend on where a
/// file or a shell stood.
void MakeAbsolute(sweep::PathTemplate& path) {
  if (path.text.empty()) return;
  path.text = std::filesystem::absolute(path.text).lexically_normal().string();
}

/// Keys that a simulated trial reads; an axis of any other would repeat the same rows.
void RequireEffect(const sweep::Parameter& parameter) {
  for (const std::string_view block : {"control.", "trial.", "simulation.", "waypoints"}) {
    if (parameter.key.starts_with(block)) return;
  }
  throw Error(fmt::format("{} does not change a simulated trial; {}", parameter.key,
                          parameter.key == "seed" ? "for repeats set reference.trials"
                                                  : "vary keys of control, trial or simulation"));
}

std::set<std::string> WholeNumberKeys(const Experiment& experiment) {
  std::set<std::string> keys;
  for (const KeyInfo& key : Describe(experiment)) {
    if (key.type.starts_with("whole number")) keys.insert(key.key);
  }
  return keys;
}

/// The picture of a heightfield, like every path of a file, is relative to that file.
void ResolveImages(Node& tree) {
  Node* node = &tree;
  for (const char* key : {"simulation", "terrain", "surfaces"}) {
    Node::Entry* entry = node->Find(key);
    if (entry == nullptr) return;
    node = &entry->value;
  }
  for (Node::Entry& surface : node->entries) {
    Node::Entry* image = surface.value.Find("image");
    if (image == nullptr || !image->value.IsScalar() || image->value.text.empty()) continue;
    sweep::PathTemplate path = Hook<sweep::PathTemplate>::FromNode(image->value);
    MakeAbsolute(path);
    image->value.text = path.text;
    image->value.quoted = true;
  }
}

/// Values to try a parameter with: its levels, or the ends of its range.
std::vector<sweep::ParameterValue> ValuesToTry(const sweep::Parameter& parameter) {
  if (!parameter.IsContinuous()) return parameter.levels;
  std::vector<sweep::ParameterValue> ends;
  for (const double end : {parameter.min, parameter.max}) {
    ends.push_back({NumberText(end, parameter.key), end});
  }
  return ends;
}

/// A rule between keys, such as v_min <= v_max, is broken for good only when no other values of
/// the other parameters keep it: their first, their last and those of the experiment are tried.
void TryValue(const Experiment& experiment, size_t parameter, const sweep::ParameterValue& value) {
  const std::vector<sweep::Parameter>& parameters = experiment.space.parameters;
  Experiment alone = experiment;
  alone.space.parameters = {parameters[parameter]};
  std::vector<sweep::Theta> around(2);
  for (size_t i = 0; i < parameters.size(); ++i) {
    const std::vector<sweep::ParameterValue> others = ValuesToTry(parameters[i]);
    around[0].push_back(i == parameter ? value : others.front());
    around[1].push_back(i == parameter ? value : others.back());
  }
  for (const sweep::Theta& theta : around) {
    try {
      ExperimentAt(experiment, theta);
      return;
    } catch (const Error&) {  // the last try tells
    }
  }
  ExperimentAt(alone, {value});
}

/// A setting of a small grid that breaks a rule is refused at once. Of a large one, and of ranges,
/// every value is tried once; a setting that still breaks a rule becomes a row that says so.
void TrySpace(const Experiment& experiment) {
  constexpr double kMostTried = 2000;
  const std::vector<sweep::Parameter>& parameters = experiment.space.parameters;
  double settings = 1.0;
  for (const sweep::Parameter& parameter : parameters) {
    settings *= parameter.IsContinuous() ? HUGE_VAL : static_cast<double>(parameter.levels.size());
  }
  if (experiment.goal != sweep::Goal::kFalsify && settings <= kMostTried) {
    for (const sweep::Theta& theta : sweep::GridPoints(parameters)) ExperimentAt(experiment, theta);
    return;
  }
  for (size_t i = 0; i < parameters.size(); ++i) {
    for (const sweep::ParameterValue& value : ValuesToTry(parameters[i])) {
      TryValue(experiment, i, value);
    }
  }
}

/// A range of a key that holds whole numbers is one of whole numbers, said or not.
void RequireWhole(sweep::Parameter& parameter) {
  parameter.is_integer = true;
  const bool is_whole = parameter.min == std::floor(parameter.min) &&
                        parameter.max == std::floor(parameter.max) && !parameter.is_logarithmic;
  if (is_whole) return;
  throw Error(fmt::format("{} holds whole numbers: its range needs whole bounds and a linear scale",
                          parameter.key));
}

/// A simulated parameter is any key of the experiment, by its full name or a short one that is
/// unique.
void ResolveSpace(Experiment& experiment) {
  const std::vector<std::string> keys = ListKeys(experiment);
  const std::set<std::string> whole_keys = WholeNumberKeys(experiment);
  for (sweep::Parameter& parameter : experiment.space.parameters) {
    try {
      parameter.key = ResolveKey(parameter.key, keys);
      RequireEffect(parameter);
      const bool is_whole = parameter.IsContinuous() && whole_keys.contains(parameter.key);
      if (is_whole) RequireWhole(parameter);
    } catch (const Error& unknown) {
      throw Error(fmt::format("{}: space: {}", parameter.origin, unknown.what()));
    }
  }
  if (experiment.goal != sweep::Goal::kFalsify) sweep::CheckGrid(experiment.space.parameters);
  TrySpace(experiment);
}

/// A text that was quoted for it would otherwise be taken for a number or for nothing.
Node LevelNode(const sweep::ParameterValue& level) {
  const Node plain = Node::Scalar(level.text);
  const bool reads_as_number = level.text.find_first_of("0123456789+-.") == 0;
  return !level.number && (reads_as_number || plain.IsNull()) ? Node::Text(level.text) : plain;
}

}  // namespace

Experiment ExperimentAt(const Experiment& experiment,
                        const std::vector<sweep::ParameterValue>& theta) {
  std::vector<KeyValue> values;
  for (size_t i = 0; i < theta.size(); ++i) {
    const sweep::Parameter& parameter = experiment.space.parameters[i];
    Node value = LevelNode(theta[i]);
    value.origin.source = parameter.origin;
    values.push_back({parameter.key, value});
  }
  Experiment at = experiment;
  SetValues(at, values);
  return at;
}

Experiment CalibratedAt(const Experiment& experiment, const std::vector<double>& values) {
  std::vector<KeyValue> pairs;
  for (size_t i = 0; i < values.size(); ++i) {
    const sweep::FreeParameter& free = experiment.calibrate.fit.list[i];
    Node value = Node::Scalar(NumberText(values[i], free.key));
    value.origin.source = free.origin;
    pairs.push_back({free.key, value});
  }
  Experiment at = experiment;
  SetValues(at, pairs);
  return at;
}

Experiment LoadExperiment(const std::string& path, const std::vector<std::string>& overrides,
                          const FileReader& read) {
  Node tree = Load(path, read);
  for (const std::string& assignment : overrides) Merge(tree, ParseOverride(assignment));
  Experiment experiment;
  experiment.name = std::filesystem::path(path).stem().string();
  ResolveImages(tree);
  Bind(tree, experiment);
  MakeAbsolute(experiment.candidate.path);
  MakeAbsolute(experiment.reference.path);
  if (experiment.candidate.kind == sweep::CandidateKind::kSimulation) ResolveSpace(experiment);
  if (experiment.goal == sweep::Goal::kCalibrate) ResolveCalibrate(experiment, path);
  return experiment;
}

std::string DescribeKeys() {
  std::string text;
  for (const KeyInfo& key : Describe<Experiment>()) {
    const std::string standard =
        key.default_text.empty() ? "" : fmt::format(" [{}]", key.default_text);
    text += fmt::format("{}: {}{}\n    {}\n", key.key, key.type, standard, key.help);
  }
  return text;
}

std::map<std::string, std::string> FlatValues(const Experiment& experiment) {
  std::map<std::string, std::string> values;
  const Node tree = ToNode(experiment);
  for (const FlatEntry& entry : Flatten(tree)) {
    std::string line;
    for (const char c : Emit(*entry.value)) {
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

std::string WriteExperiment(const Experiment& experiment) { return Emit(ToNode(experiment)); }

}  // namespace rift::config
