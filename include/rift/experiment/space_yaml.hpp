#pragma once

#include <string>
#include <string_view>

#include "rift/experiment/options.hpp"
#include "rift/yaml/bind.hpp"
#include "rift/yaml/fields.hpp"

namespace rift::experiment {

/// A value of a parameter that YAML holds: plain numbers are numbers, the rest are words. `null`,
/// of a key that may have no value, is a word as well. Throws Error naming `key` for lists,
/// maps and the text "null".
ParameterValue ValueFromNode(const yaml::Node& node, const std::string& key);

/// The way back, for a space as for a key: what ValueFromNode reads as the same value.
yaml::Node ValueToNode(const ParameterValue& value);

/// The value for yaml::SetValues; what is wrong with it is said to stand at `origin`.
yaml::KeyValue ValueOfKey(const std::string& key, const ParameterValue& value,
                          const yaml::Origin& origin);

}  // namespace rift::experiment

/// How the values of a sweep that are no plain fields stand in YAML.
namespace rift::yaml {

template <>
struct Hook<experiment::PathTemplate> {
  static constexpr std::string_view kTypeText = "path, or a template such as {surface}_{trial}.csv";
  static experiment::PathTemplate FromNode(const Node& node);
  static Node ToNode(const experiment::PathTemplate& path);
};

template <>
struct Hook<experiment::CommandLine> {
  static constexpr std::string_view kTypeText = "list of a program and its arguments";
  static experiment::CommandLine FromNode(const Node& node);
  static Node ToNode(const experiment::CommandLine& line);
};

template <>
struct Hook<experiment::TrialList> {
  static constexpr std::string_view kTypeText = "list of names, or a count";
  static experiment::TrialList FromNode(const Node& node);
  static Node ToNode(const experiment::TrialList& trials);
};

template <>
struct Hook<experiment::Space> {
  static constexpr std::string_view kTypeText =
      "parameter: [values], or {min, max}; see docs/concepts.md";
  static experiment::Space FromNode(const Node& node);
  static Node ToNode(const experiment::Space& space);
};

template <>
struct Hook<experiment::HeldOutTrials> {
  static constexpr std::string_view kTypeText = "list of names";
  static experiment::HeldOutTrials FromNode(const Node& node);
  static Node ToNode(const experiment::HeldOutTrials& trials);
};

template <>
struct Hook<experiment::FreeParameters> {
  static constexpr std::string_view kTypeText = "key: {min, max}";
  static experiment::FreeParameters FromNode(const Node& node);
  static Node ToNode(const experiment::FreeParameters& fit);
};

}  // namespace rift::yaml
