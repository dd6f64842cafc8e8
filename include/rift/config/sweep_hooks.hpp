#pragma once

#include <string_view>

#include "rift/config/fields.hpp"
#include "rift/sweep/calibrate_options.hpp"
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

template <>
struct Hook<sweep::HeldOutTrials> {
  static constexpr std::string_view kTypeText = "list of names";
  static sweep::HeldOutTrials FromNode(const Node& node);
  static Node ToNode(const sweep::HeldOutTrials& trials);
};

template <>
struct Hook<sweep::FreeParameters> {
  static constexpr std::string_view kTypeText = "key: {min, max}";
  static sweep::FreeParameters FromNode(const Node& node);
  static Node ToNode(const sweep::FreeParameters& fit);
};

}  // namespace rift::config
