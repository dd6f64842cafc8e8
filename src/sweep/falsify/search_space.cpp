#include "rift/sweep/falsify/search_space.hpp"

#include <algorithm>
#include <cmath>

namespace rift::sweep {
namespace {

search::Axis AxisOf(const experiment::Parameter& parameter) {
  search::Axis axis{.name = parameter.key};
  if (!parameter.IsContinuous()) {
    axis.kind =
        parameter.IsCategorical() ? search::AxisKind::kCategorical : search::AxisKind::kInteger;
    axis.max = static_cast<double>(parameter.levels.size()) - 1.0;
    return axis;
  }
  axis.min = parameter.min;
  axis.max = parameter.max;
  if (parameter.is_integer) axis.kind = search::AxisKind::kInteger;
  if (parameter.is_logarithmic) {
    axis.min = std::log(parameter.min);
    axis.max = std::log(parameter.max);
  }
  return axis;
}

experiment::ParameterValue LevelAt(const experiment::Parameter& parameter, double rank) {
  experiment::Theta levels = parameter.levels;
  if (!parameter.IsCategorical()) {
    std::sort(levels.begin(), levels.end(),
              [](const auto& a, const auto& b) { return *a.number < *b.number; });
  }
  return levels.at(static_cast<size_t>(std::lround(rank)));
}

experiment::ParameterValue ValueAt(const experiment::Parameter& parameter, double coordinate) {
  if (!parameter.IsContinuous()) return LevelAt(parameter, coordinate);
  double value = parameter.is_logarithmic ? std::exp(coordinate) : coordinate;
  value = std::clamp(value, parameter.min, parameter.max);  // exp(log(max)) may exceed max
  if (parameter.is_integer) value = std::round(value);
  return experiment::NumberValue(value);
}

}  // namespace

std::vector<search::Axis> AxesOf(const std::vector<experiment::Parameter>& parameters) {
  std::vector<search::Axis> axes;
  for (const experiment::Parameter& parameter : parameters) axes.push_back(AxisOf(parameter));
  return axes;
}

experiment::Theta ThetaAt(const std::vector<experiment::Parameter>& parameters,
                          const search::Point& point) {
  experiment::Theta theta;
  for (size_t i = 0; i < parameters.size(); ++i) {
    theta.push_back(ValueAt(parameters[i], point.at(i)));
  }
  return theta;
}

}  // namespace rift::sweep
