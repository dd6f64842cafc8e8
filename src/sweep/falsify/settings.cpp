#include "rift/sweep/falsify/settings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <span>

#include "rift/statistics/hash.hpp"
#include "rift/statistics/random.hpp"
#include "rift/sweep/falsify/result.hpp"
#include "rift/trajectory/csv.hpp"
#include "rift/yaml/bind.hpp"
#include "rift/yaml/enum_name.hpp"

namespace rift::sweep {

using experiment::Experiment;

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

/// Text that would leave open where the value ends is quoted.
std::string ValueKey(const experiment::ParameterValue& value) {
  if (value.number) return experiment::NumberValue(*value.number).text;
  return trajectory::csv::Cell(value.text, " =\"");
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

std::string SettingKey(const std::vector<experiment::Parameter>& parameters,
                       const experiment::Theta& theta) {
  std::string key;
  for (size_t i = 0; i < theta.size(); ++i) {
    key += fmt::format("{}={} ", parameters[i].key, ValueKey(theta[i]));
  }
  return key;
}

std::string TrialKey(const std::vector<experiment::Parameter>& parameters,
                     const TrialRequest& request) {
  return SettingKey(parameters, request.theta) +
         fmt::format("trial={} seed={}", request.trial, request.seed.value_or(0));
}

nlohmann::ordered_json ValueJson(const experiment::ParameterValue& value) {
  return value.number ? nlohmann::ordered_json(*value.number) : nlohmann::ordered_json(value.text);
}

bool IsSameSetting(const experiment::Theta& a, const experiment::Theta& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), experiment::SameValue);
}

Experiment ExperimentFor(const Experiment& experiment, const TrialRequest& request) {
  const bool is_simulated = experiment.candidate.kind == experiment::CandidateKind::kSimulation;
  return is_simulated ? experiment::ExperimentAt(experiment, request.theta) : experiment;
}

double TagAhead_m(const Experiment& experiment, const TrialRequest& request) {
  if (experiment.candidate.kind != experiment::CandidateKind::kSimulation) return 0.0;
  const Experiment at = ExperimentFor(experiment, request);
  return experiment::DrawnAt(at, request.seed.value_or(at.seed)).simulation.mocap.tag_ahead_m;
}

control::NavigatorOptions ControllerFor(const Experiment& experiment, const TrialRequest& request) {
  control::NavigatorOptions control = experiment.control;
  std::vector<yaml::KeyValue> values;
  for (const std::string& key : yaml::ListKeys(control)) {
    for (size_t i = 0; i < request.theta.size(); ++i) {
      const experiment::ParameterValue& value = request.theta[i];
      const std::string& name = experiment.space.parameters[i].key;
      const bool is_meant = value.number && (name == key || name == "control." + key);
      if (is_meant) values.push_back({key, experiment::ValueToNode(value)});
    }
  }
  yaml::SetValues(control, values);
  return control;
}

std::optional<gap::Goal> WayGoalOf(const Experiment& experiment, const TrialRow& row) {
  const bool has_goal = experiment.waypoints.size() > 1 && experiment.program.segments.empty() &&
                        experiment.objective == experiment::Objective::kGap;
  if (!has_goal || experiment.falsify.count.stop) return std::nullopt;
  const Experiment at = ExperimentFor(experiment, RequestOf(row));
  return gap::Goal{at.waypoints.back().Position(), at.control.reach_radius_m};
}

TrialRequest NominalRequest(const Experiment& experiment, std::optional<std::uint64_t> seed) {
  return {.theta = experiment::NominalTheta(experiment),
          .trial = experiment.reference.trials.names.front(),
          .seed = seed};
}

std::optional<std::uint64_t> FirstSeed(const Experiment& experiment) {
  if (experiment.candidate.kind == experiment::CandidateKind::kLogs) return std::nullopt;
  return experiment.seed;
}

std::uint64_t FreshSeed(std::uint64_t seed, std::uint64_t stream) {
  return statistics::SeedOfStream(seed, stream) >> 33;
}

namespace {

std::uint64_t FirstSeedAt(const Experiment& experiment, const experiment::Theta& theta,
                          TrialKind kind) {
  if (kind == TrialKind::kComparison) return experiment.seed;
  const std::string key = SettingKey(experiment.space.parameters, theta);
  return FreshSeed(experiment.seed, statistics::Hash64(std::as_bytes(std::span(key))));
}

}  // namespace

std::vector<TrialRequest> GridTrials(const std::vector<experiment::Parameter>& parameters,
                                     const std::vector<std::string>& trials) {
  std::vector<TrialRequest> requests;
  for (const experiment::Theta& theta : experiment::GridPoints(parameters)) {
    for (const std::string& trial : trials) requests.push_back({.theta = theta, .trial = trial});
  }
  return requests;
}

std::vector<TrialRequest> FurtherTrials(const Experiment& experiment,
                                        const experiment::Theta& theta, TrialKind kind, int before,
                                        int count) {
  const std::vector<std::string>& trials = experiment.reference.trials.names;
  const bool is_simulated = FirstSeed(experiment).has_value();
  std::vector<TrialRequest> requests;
  for (int i = before; i < before + count; ++i) {
    TrialRequest request{.theta = theta,
                         .trial = trials[static_cast<size_t>(i) % trials.size()],
                         .is_random_draw = kind == TrialKind::kRandomDraw};
    if (is_simulated)
      request.seed = FirstSeedAt(experiment, theta, kind) + static_cast<std::uint64_t>(i);
    requests.push_back(std::move(request));
  }
  return requests;
}

std::vector<TrialRequest> TrialsAt(const Experiment& experiment, const experiment::Theta& theta,
                                   TrialKind kind) {
  return FurtherTrials(experiment, theta, kind, 0,
                       static_cast<int>(experiment.reference.trials.names.size()));
}

SweepResult EmptyResult(const Experiment& experiment) {
  SweepResult result;
  result.name = experiment.name;
  result.candidate_kind = yaml::NameOf(experiment.candidate.kind);
  result.reference_kind = yaml::NameOf(experiment.reference.kind);
  result.gap = experiment.gap;
  result.judged_by = experiment.falsify;
  result.tag_offset_m = experiment.reference.tag_offset_m;
  result.parameters = experiment.space.parameters;
  return result;
}

}  // namespace rift::sweep
