#include "rift/experiment/words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "rift/experiment/experiment.hpp"
#include "rift/yaml/describe.hpp"

namespace rift::experiment {
namespace {

/// Endings of keys; a longer one stands before those that it ends with.
constexpr std::array<std::pair<std::string_view, std::string_view>, 18> kUnits{{
    {"_rad_per_mps", "rad/(m/s)"},
    {"_ns_per_m", "N s/m"},
    {"_n_per_m", "N/m"},
    {"_rad_s", "rad/s"},
    {"_kg_m2", "kg m²"},
    {"_mps2", "m/s²"},
    {"_deg_s", "°/s"},
    {"_mps", "m/s"},
    {"_rad", "rad"},
    {"_deg", "°"},
    {"_kg", "kg"},
    {"_nm", "N m"},
    {"_hz", "Hz"},
    {"_ms", "ms"},
    {"_mm", "mm"},
    {"_px", "px"},
    {"_m", "m"},
    {"_s", "s"},
}};

std::pair<std::string_view, std::string_view> Split(std::string_view name) {
  for (const auto& [ending, unit] : kUnits) {
    if (name.size() > ending.size() && name.ends_with(ending)) {
      return {name.substr(0, name.size() - ending.size()), unit};
    }
  }
  return {name, ""};
}

std::string_view LastPart(std::string_view key) {
  const std::size_t dot = key.rfind('.');
  return dot == std::string_view::npos ? key : key.substr(dot + 1);
}

}  // namespace

std::string UnitOf(std::string_view name) { return std::string(Split(name).second); }

std::string LabelOf(std::string_view name) {
  const auto [word, unit] = Split(name);
  return unit.empty() ? std::string(word) : fmt::format("{} ({})", word, unit);
}

std::string NamedValue(const Parameter& parameter, const std::string& value_text) {
  if (parameter.IsCategorical()) return value_text;
  const std::string name = parameter.Name();
  const auto [word, unit] = Split(name);
  return fmt::format("{} {}{}{}", word, value_text, unit.empty() ? "" : " ", unit);
}

std::string HelpOf(std::string_view key) {
  static const std::vector<yaml::KeyInfo> keys = yaml::Describe<Experiment>();
  std::string by_name;
  int found = 0;
  for (const yaml::KeyInfo& info : keys) {
    if (info.key == key) return info.help;
    if (LastPart(info.key) != LastPart(key)) continue;
    by_name = info.help;
    ++found;
  }
  return found == 1 ? by_name : "";
}

}  // namespace rift::experiment
