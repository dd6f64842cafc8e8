#include "rift/experiment/space_yaml.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>
#include <string_view>

#include "rift/yaml/node.hpp"
#include "rift/yaml/scalar.hpp"

namespace rift::experiment {

constexpr const char* kNull = "null";

ParameterValue ValueFromNode(const yaml::Node& node, const std::string& key) {
  if (node.IsNull()) return {kNull, std::nullopt};
  if (node.text == kNull) yaml::Fail(node, key, "a text that cannot be told from no value");
  if (!node.IsScalar()) yaml::Fail(node, key, "every value of an axis must be a number or a text");
  return {node.text, yaml::NumberOf(node)};
}

yaml::Node ValueToNode(const ParameterValue& value) {
  if (value.text == kNull) return {};
  const bool was_quoted = !value.number && yaml::NumberOf(value.text);
  return was_quoted ? yaml::Node::Text(value.text) : yaml::Node::Scalar(value.text);
}

yaml::KeyValue ValueOfKey(const std::string& key, const ParameterValue& value,
                          const yaml::Origin& origin) {
  yaml::Node node = ValueToNode(value);
  node.origin = origin;
  return {key, std::move(node)};
}

}  // namespace rift::experiment

namespace rift::yaml {
namespace {

/// Tables and sentences have names and values of parameters in their lines.
void RequireOneLine(const std::string& text, const Node& node, const std::string& key) {
  if (text.find_first_of("\n\r") == text.npos) return;
  Fail(node, key, "names and values of parameters have no line breaks");
}

void ReadLevels(const Node& node, const std::string& key, experiment::Parameter& parameter) {
  if (node.items.empty()) Fail(node, key, "an axis needs at least one value");
  std::set<std::string> texts;  // two levels are one where SameValue says so
  std::set<double> numbers;
  for (const Node& item : node.items) {
    const experiment::ParameterValue level = experiment::ValueFromNode(item, key);
    const bool is_new =
        texts.insert(level.text).second && (!level.number || numbers.insert(*level.number).second);
    if (!is_new) Fail(item, key, "an axis has each value once");
    RequireOneLine(level.text, item, key);
    parameter.levels.push_back(level);
  }
}

bool IsWhole(double value) { return value == std::floor(value); }

void ReadRangeKind(const Node& node, const std::string& key, experiment::Parameter& parameter) {
  if (const Node::Entry* entry = node.Find("integer")) {
    parameter.is_integer = ReadBool(entry->value, {Join(key, "integer"), {}, ""});
  }
  if (const Node::Entry* entry = node.Find("scale")) {
    constexpr std::array<std::string_view, 2> kScales{"linear", "log"};
    parameter.is_logarithmic = ReadName(entry->value, {Join(key, "scale"), {}, ""}, kScales) == 1;
  }
  if (parameter.is_logarithmic && (parameter.is_integer || parameter.min <= 0.0)) {
    Fail(
        node, key,
        fmt::format("scale: log needs min above 0, which is {:g}, and no integers", parameter.min));
  }
  if (parameter.is_integer && !(IsWhole(parameter.min) && IsWhole(parameter.max))) {
    Fail(node, key, "min and max of integers must be whole");
  }
}

void ReadRange(const Node& node, const std::string& key, experiment::Parameter& parameter) {
  for (const char* bound : {"min", "max"}) {
    const Node::Entry* entry = node.Find(bound);
    if (entry == nullptr)
      Fail(node, key, fmt::format("a range needs min and max; {} is missing", bound));
    const std::optional<double> number = NumberOf(entry->value);
    if (!number) Fail(entry->value, Join(key, bound), "must be a number");
    (bound[1] == 'i' ? parameter.min : parameter.max) = *number;
  }
  if (!(parameter.min < parameter.max)) {
    Fail(node, key,
         fmt::format("min is {:g}, and it must be below max, which is {:g}", parameter.min,
                     parameter.max));
  }
  ReadRangeKind(node, key, parameter);
}

/// What may stand in the map of an axis beside its values.
void ReadSettable(const Node& node, const std::string& key, experiment::Parameter& parameter) {
  if (const Node::Entry* entry = node.Find("nominal")) {
    parameter.nominal = NumberOf(entry->value);
    const bool is_value = parameter.nominal && parameter.IsContinuous() &&
                          *parameter.nominal >= parameter.min &&
                          *parameter.nominal <= parameter.max;
    if (!is_value) Fail(entry->value, Join(key, "nominal"), "must be a number in its range");
    if (parameter.is_integer && !IsWhole(*parameter.nominal)) {
      Fail(entry->value, Join(key, "nominal"), "must be whole, as the integers of its range");
    }
  }
  if (const Node::Entry* entry = node.Find("settable")) {
    parameter.settable = ReadBool(entry->value, {Join(key, "settable"), {}, ""});
  }
  const Node::Entry* entry = node.Find("step");
  if (entry == nullptr) return;
  parameter.step = NumberOf(entry->value);
  const bool is_step = parameter.step && *parameter.step > 0.0;
  if (!is_step) Fail(entry->value, Join(key, "step"), "must be a number above 0");
  if (parameter.is_integer && !IsWhole(*parameter.step)) {
    Fail(entry->value, Join(key, "step"), "must be whole, as the integers of its range");
  }
  if (!parameter.IsContinuous()) {
    Fail(entry->value, Join(key, "step"), "belongs to a range: a list is set as it is written");
  }
}

void ReadAxis(const Node& node, const std::string& key, experiment::Parameter& parameter) {
  if (const Node::Entry* values = node.Find("values")) {
    for (const char* other : {"min", "max", "scale", "integer"}) {
      if (node.Find(other)) Fail(node, key, "has values, or min and max: not both");
    }
    if (!values->value.IsList()) Fail(values->value, Join(key, "values"), "must be a list");
    ReadLevels(values->value, key, parameter);
  } else {
    ReadRange(node, key, parameter);
  }
  ReadSettable(node, key, parameter);
}

experiment::Parameter ParameterFromEntry(const FlatEntry& entry) {
  const std::string key = Join("space", entry.key);
  RequireOneLine(entry.key, *entry.value, key);
  experiment::Parameter parameter{.key = entry.key, .origin = entry.origin.Text()};
  if (entry.value->IsList()) {
    ReadLevels(*entry.value, key, parameter);
  } else if (IsAxis(*entry.value)) {
    ReadAxis(*entry.value, key, parameter);
  } else {
    Fail(*entry.value, key, "must be a list of values, or {min: a, max: b}");
  }
  return parameter;
}

constexpr const char* kRangeOfFit =
    "must be {min: a, max: b}, or with what is known of it {min: a, max: b, mean: m, sd: s}";

/// A map with one of these keys is a range, and not the rest of a dotted key.
bool IsRangeOfFit(const Node& node) {
  return node.IsMap() && (node.Find("min") != nullptr || node.Find("max") != nullptr);
}

void ReadPrior(const Node& node, const std::string& key, experiment::FreeParameter& free) {
  for (const Node::Entry& entry : node.entries) {
    const bool is_bound = entry.key == "min" || entry.key == "max";
    if (is_bound) continue;
    if (entry.key != "mean" && entry.key != "sd") Fail(node, key, kRangeOfFit);
    const std::optional<double> number = NumberOf(entry.value);
    if (!number) Fail(entry.value, Join(key, entry.key), "must be a number");
    (entry.key == "sd" ? free.prior_sd : free.prior_mean) = *number;
  }
  if (node.entries.size() == 2) return;
  if (node.entries.size() != 4) Fail(node, key, kRangeOfFit);
  if (!(free.prior_sd > 0.0)) Fail(node, Join(key, "sd"), "must be above 0");
  if (free.prior_mean < free.min || free.prior_mean > free.max) {
    Fail(node, Join(key, "mean"), "must lie in the range");
  }
}

/// Names that table.csv, or a path template, has for something else.
void CheckIsNoColumn(const Node& node, const std::string& name) {
  if (name == "trial") {
    Fail(node, "space", "'trial' is the name of the repeats: see reference.trials");
  }
  if (name == "seed") {
    Fail(node, "space", "seed does not change a trial's kind; for repeats set reference.trials");
  }
  for (const std::string_view column : experiment::kFixedColumns) {
    if (name != column) continue;
    Fail(node, "space", fmt::format("'{}' is a column of table.csv already", name));
  }
}

/// Columns and path templates know a parameter by its last name.
void CheckNames(const Node& node, const std::vector<experiment::Parameter>& parameters) {
  std::map<std::string, const experiment::Parameter*> first_with;
  for (const experiment::Parameter& parameter : parameters) {
    const auto [first, is_new] = first_with.emplace(parameter.Name(), &parameter);
    if (!is_new) {
      Fail(node, "space",
           fmt::format("{} and {} have the same last name '{}'", first->second->key, parameter.key,
                       parameter.Name()));
    }
    CheckIsNoColumn(node, parameter.Name());
  }
}

}  // namespace

experiment::PathTemplate Hook<experiment::PathTemplate>::FromNode(const Node& node) {
  if (!node.IsScalar()) throw std::invalid_argument("must be a path");
  const bool from_file = node.origin.line > 0;
  const std::filesystem::path written = node.text;
  if (node.text.empty() || written.is_absolute() || !from_file) return {node.text};
  const std::filesystem::path folder = std::filesystem::path(node.origin.source).parent_path();
  return {(folder / written).lexically_normal().string()};
}

Node Hook<experiment::PathTemplate>::ToNode(const experiment::PathTemplate& path) {
  return Node::Text(path.text);
}

experiment::CommandLine Hook<experiment::CommandLine>::FromNode(const Node& node) {
  if (!node.IsList()) throw std::invalid_argument("must be a list: [python3, sim.py, ...]");
  experiment::CommandLine line;
  for (const Node& item : node.items) {
    if (!item.IsScalar()) throw std::invalid_argument("every argument must be a text or a number");
    const std::filesystem::path beside =
        std::filesystem::path(item.origin.source).parent_path() / item.text;
    std::error_code none;
    const bool is_file = item.origin.line > 0 && !item.text.empty() &&
                         std::filesystem::is_regular_file(beside, none);
    line.words.push_back(is_file ? std::filesystem::absolute(beside).lexically_normal().string()
                                 : item.text);
  }
  return line;
}

Node Hook<experiment::CommandLine>::ToNode(const experiment::CommandLine& line) {
  Node list = Node::List();
  for (const std::string& word : line.words) list.items.push_back(Node::Text(word));
  return list;
}

experiment::TrialList Hook<experiment::TrialList>::FromNode(const Node& node) {
  experiment::TrialList trials{{}};
  if (node.IsScalar()) {
    const std::optional<double> count = NumberOf(node);
    if (!count || *count != std::floor(*count) || *count < 1 || *count > 1e6) {
      throw std::invalid_argument("must be a list of trials, or how many there are (1 or more)");
    }
    for (int i = 1; i <= static_cast<int>(*count); ++i)
      trials.names.push_back(fmt::format("{}", i));
    return trials;
  }
  if (!node.IsList() || node.items.empty()) {
    throw std::invalid_argument("must be a list of trials, or how many there are");
  }
  std::set<std::string_view> seen;
  for (const Node& item : node.items) {
    if (!item.IsScalar()) throw std::invalid_argument("every trial must be a number or a name");
    if (!seen.insert(item.text).second) {
      throw std::invalid_argument(fmt::format("trial {} stands there twice", item.text));
    }
    trials.names.push_back(item.text);
  }
  return trials;
}

Node Hook<experiment::TrialList>::ToNode(const experiment::TrialList& trials) {
  Node list = Node::List();
  for (const std::string& name : trials.names) {
    Node item = Node::Scalar(name);
    list.items.push_back(NumberOf(item) ? item : Node::Text(name));
  }
  return list;
}

experiment::HeldOutTrials Hook<experiment::HeldOutTrials>::FromNode(const Node& node) {
  if (!node.IsList()) throw std::invalid_argument("must be a list of trials, [] for none");
  if (node.items.empty()) return {};
  return {Hook<experiment::TrialList>::FromNode(node).names};
}

Node Hook<experiment::HeldOutTrials>::ToNode(const experiment::HeldOutTrials& trials) {
  return Hook<experiment::TrialList>::ToNode({trials.names});
}

experiment::FreeParameters Hook<experiment::FreeParameters>::FromNode(const Node& node) {
  if (!node.IsMap()) throw std::invalid_argument("must be a map of keys, each with {min, max}");
  experiment::FreeParameters fit;
  for (const FlatEntry& entry : Flatten(node, IsRangeOfFit)) {
    const std::string key = Join("calibrate.fit", entry.key);
    if (!IsRangeOfFit(*entry.value)) Fail(*entry.value, key, kRangeOfFit);
    experiment::Parameter range;
    ReadRange(*entry.value, key, range);
    fit.list.push_back({.key = entry.key,
                        .min = range.min,
                        .max = range.max,
                        .start = range.min,
                        .origin = entry.origin.Text()});
    ReadPrior(*entry.value, key, fit.list.back());
  }
  return fit;
}

Node Hook<experiment::FreeParameters>::ToNode(const experiment::FreeParameters& fit) {
  Node map = Node::Map();
  for (const experiment::FreeParameter& free : fit.list) {
    Node range = Node::Map();
    range.Add("min", Node::Scalar(NumberText(free.min, free.key)));
    range.Add("max", Node::Scalar(NumberText(free.max, free.key)));
    if (free.prior_sd > 0.0) {
      range.Add("mean", Node::Scalar(NumberText(free.prior_mean, free.key)));
      range.Add("sd", Node::Scalar(NumberText(free.prior_sd, free.key)));
    }
    map.Add(free.key, range);
  }
  return map;
}

experiment::Space Hook<experiment::Space>::FromNode(const Node& node) {
  if (!node.IsMap()) throw std::invalid_argument("must be a map of parameters");
  experiment::Space space;
  for (const FlatEntry& entry : Flatten(node)) {
    space.parameters.push_back(ParameterFromEntry(entry));
  }
  CheckNames(node, space.parameters);
  return space;
}

Node Hook<experiment::Space>::ToNode(const experiment::Space& space) {
  Node map = Node::Map();
  for (const experiment::Parameter& parameter : space.parameters) {
    Node axis = Node::List();
    for (const experiment::ParameterValue& level : parameter.levels) {
      axis.items.push_back(experiment::ValueToNode(level));
    }
    if (parameter.IsContinuous()) {
      axis = Node::Map();
      axis.Add("min", Node::Scalar(NumberText(parameter.min, parameter.key)));
      axis.Add("max", Node::Scalar(NumberText(parameter.max, parameter.key)));
      if (parameter.is_integer) axis.Add("integer", Node::Scalar("true"));
      if (parameter.is_logarithmic) axis.Add("scale", Node::Scalar("log"));
      if (parameter.step) {
        axis.Add("step", Node::Scalar(NumberText(*parameter.step, parameter.key)));
      }
      if (parameter.nominal) {
        axis.Add("nominal", Node::Scalar(NumberText(*parameter.nominal, parameter.key)));
      }
    } else if (parameter.settable) {
      Node with_values = Node::Map();
      with_values.Add("values", std::move(axis));
      axis = std::move(with_values);
    }
    if (parameter.settable) {
      axis.Add("settable", Node::Scalar(*parameter.settable ? "true" : "false"));
    }
    map.Add(parameter.key, axis);
  }
  return map;
}

}  // namespace rift::yaml
