#include "rift/experiment/parameter.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "rift/yaml/scalar.hpp"

namespace rift::experiment {

namespace {

/// Each setting is at least a trial; more than these would not end in a lifetime of a laptop.
constexpr double kMostSettings = 1e6;

}  // namespace

std::string Parameter::Name() const { return key.substr(key.rfind('.') + 1); }

bool Parameter::IsCategorical() const {
  return std::any_of(levels.begin(), levels.end(),
                     [](const ParameterValue& level) { return !level.number; });
}

bool SameValue(const ParameterValue& a, const ParameterValue& b) {
  return a.number && b.number ? *a.number == *b.number : a.text == b.text;
}

ParameterValue NumberValue(double number) {
  if (!std::isfinite(number))
    throw std::invalid_argument("the value of a parameter must be finite");
  return {yaml::NumberText(number), number};
}

ParameterValue ParseValue(const Parameter& parameter, const std::string& text) {
  for (const ParameterValue& level : parameter.levels) {
    if (level.text == text) return level;
  }
  return {text, parameter.IsCategorical() ? std::nullopt : yaml::NumberOf(text)};
}

Space PaperSpace() {
  return {{{.key = "simulation.terrain.surface",
            .levels = {{"ground", {}},
                       {"cardboard", {}},
                       {"parchment", {}},
                       {"uphill", {}},
                       {"downhill", {}}}},
           {.key = "control.v_min", .levels = {{"0.15", 0.15}, {"0.20", 0.20}}},
           {.key = "control.v_max", .levels = {{"0.30", 0.30}, {"0.40", 0.40}, {"0.50", 0.50}}}}};
}

void CheckGrid(const std::vector<Parameter>& parameters) {
  double settings = 1.0;
  for (const Parameter& parameter : parameters) {
    if (parameter.IsContinuous()) {
      throw std::invalid_argument(
          fmt::format("{}: space.{} is a range, and a grid needs the values to visit: write a "
                      "list, or set goal: falsify",
                      parameter.origin, parameter.key));
    }
    settings *= static_cast<double>(parameter.levels.size());
  }
  if (settings > kMostSettings) {
    throw std::invalid_argument(fmt::format(
        "space is a grid of {:.3g} settings: at most {:.0e} are possible; shorten its lists",
        settings, kMostSettings));
  }
}

std::vector<Theta> GridPoints(const std::vector<Parameter>& parameters) {
  CheckGrid(parameters);
  std::vector<Theta> points{{}};
  for (const Parameter& parameter : parameters) {
    std::vector<Theta> longer;
    longer.reserve(points.size() * parameter.levels.size());
    for (const auto& point : points) {
      for (const ParameterValue& level : parameter.levels) {
        longer.push_back(point);
        longer.back().push_back(level);
      }
    }
    points = std::move(longer);
  }
  return points;
}

}  // namespace rift::experiment
