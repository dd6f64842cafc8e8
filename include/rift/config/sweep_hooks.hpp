#pragma once

#include <string_view>

#include "rift/config/fields.hpp"
#include "rift/sweep/options.hpp"

/// How the values of a sweep that are no plain fields stand in YAML.
namespace rift::config {

template <>
struct Hook<sweep::PathTemplate> {
  static constexpr std::string_view kTypeText = "path, or a template such as {surface}_{trial}.csv";
  static sweep::PathTemplate FromNode(const Node& node);
  static Node ToNode(const sweep::PathTemplate& path);
};

template <>
struct Hook<sweep::TrialList> {
  static constexpr std::string_view kTypeText = "list of names, or a count";
  static sweep::TrialList FromNode(const Node& node);
  static Node ToNode(const sweep::TrialList& trials);
};

template <>
struct Hook<sweep::Space> {
  static constexpr std::string_view kTypeText = "parameter: [values], or {min, max}";
  static sweep::Space FromNode(const Node& node);
  static Node ToNode(const sweep::Space& space);
};

}  // namespace rift::config
