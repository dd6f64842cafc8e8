#include "calibrate_keys.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <set>
#include <string_view>

#include "rift/yaml/describe.hpp"
#include "rift/yaml/node.hpp"
#include "setting_check.hpp"

namespace rift::experiment {
namespace {

/// `surfaces.{surface}.mu` -> one key for each surface of the space; a key without braces as it is.
std::vector<FreeParameter> Expand(const FreeParameter& free, const Space& space) {
  const size_t open = free.key.find('{'), close = free.key.find('}', open);
  if (open == std::string::npos || close == std::string::npos) return {free};
  const std::string name = free.key.substr(open + 1, close - open - 1);
  std::vector<std::string> known;
  std::vector<FreeParameter> expanded;
  for (const Parameter& parameter : space.parameters) {
    known.push_back(parameter.Name());
    if (parameter.Name() != name) continue;
    for (const ParameterValue& level : parameter.levels) {
      FreeParameter one = free;
      one.key.replace(open, close - open + 1, level.text);
      expanded.push_back(one);
    }
  }
  if (expanded.empty()) {
    throw yaml::Error(fmt::format(
        "{}: calibrate.fit: {} asks for a parameter '{}' of space, which has {}", free.origin,
        free.key, name, known.empty() ? "none" : fmt::format("{}", fmt::join(known, ", "))));
  }
  return expanded;
}

double StartOf(const FreeParameter& free, const Experiment& experiment) {
  const yaml::Node value = yaml::GetValue(experiment, free.key);
  const std::optional<double> start = yaml::NumberOf(value);
  if (!start) {
    throw yaml::Error(fmt::format("{}: calibrate.fit: {} is {}, and only a number can be fitted{}",
                                  free.origin, free.key, yaml::Shown(value),
                                  value.IsNull() ? "; give it a value to start from" : ""));
  }
  if (*start < free.min || *start > free.max) {
    throw yaml::Error(
        fmt::format("{}: calibrate.fit: {} starts at {}, which the experiment gives it, but its "
                    "range is [{}, {}]; widen it or set another start",
                    free.origin, free.key, *start, free.min, free.max));
  }
  return *start;
}

void RequireSimulatorAndLogs(const Experiment& experiment, const std::string& path) {
  const auto refuse = [&path](const std::string& why) {
    throw yaml::Error(fmt::format("{}: goal is calibrate, {}", path, why));
  };
  if (experiment.candidate.kind == CandidateKind::kLogs) {
    refuse("and candidate.kind is logs: only a simulator can be fitted");
  }
  const bool is_program = experiment.candidate.kind == CandidateKind::kProgram;
  if (experiment.reference.kind != ReferenceKind::kLogs) {
    refuse("and reference.kind is not logs: name the robot's logs in reference.path");
  }
  if (experiment.reference.tag_offset_m != 0.0 && !is_program) {
    refuse(
        fmt::format("and reference.tag_offset_m is {}, but the fit needs the logs as the tag "
                    "moved: leave it out and set simulation.mocap.tag_ahead_m",
                    experiment.reference.tag_offset_m));
  }
  if (experiment.gap.IsInSpace()) {
    refuse("and gap.dimension is xyz: a fit looks at speeds, turns and sideways slip in the plane");
  }
  if (experiment.calibrate.fit.list.empty()) {
    refuse(fmt::format(
        "and calibrate.fit is empty: name parameters, such as {{{}}}",
        is_program ? "mu: {min: 0.1, max: 1}" : "motor.mismatch: {min: -0.1, max: 0.1}"));
  }
}

void CheckHoldout(const Experiment& experiment, const std::string& path) {
  const std::vector<std::string>& trials = experiment.reference.trials.names;
  const std::vector<std::string>& held = experiment.calibrate.holdout.names;
  const std::set<std::string_view> known(trials.begin(), trials.end());
  for (const std::string& name : held) {
    if (known.contains(name)) continue;
    throw yaml::Error(
        fmt::format("{}: calibrate.holdout names trial {}, and reference.trials has {}", path, name,
                    fmt::join(trials, ", ")));
  }
  if (held.size() < trials.size()) return;
  throw yaml::Error(fmt::format(
      "{}: calibrate.holdout names all of reference.trials, so that none is left to fit", path));
}

/// A trial reads the logs of one setting and the values at it: a parameter is one or the other.
void CheckIsNotInSpace(const FreeParameter& free, const Space& space) {
  for (const Parameter& parameter : space.parameters) {
    if (parameter.key != free.key) continue;
    throw yaml::Error(
        fmt::format("{}: calibrate.fit: {} is a parameter of space as well; leave it out "
                    "of one of them",
                    free.origin, free.key));
  }
}

/// A short name, a full one and one with braces may be the same key.
void CheckIsNamedOnce(const FreeParameter& free, const std::vector<FreeParameter>& others) {
  for (const FreeParameter& other : others) {
    if (other.key != free.key) continue;
    throw yaml::Error(fmt::format("{}: calibrate.fit: {} stands there twice: it is at {} already",
                                  free.origin, free.key, other.origin));
  }
}

/// Names that the arguments of a program have for something else.
constexpr std::array<std::string_view, 5> kNamesOfTrial{"seed", "trial", "out", "theta", "folder"};

void CheckNameOfProgram(const FreeParameter& free, const std::set<std::string>& others) {
  const auto refuse = [&free](const std::string& why) {
    throw yaml::Error(fmt::format("{}: calibrate.fit: {} {}", free.origin, free.key, why));
  };
  const std::string name = Parameter{.key = free.key}.Name();
  if (std::find(kNamesOfTrial.begin(), kNamesOfTrial.end(), name) != kNamesOfTrial.end()) {
    refuse(fmt::format("is what a program's trial calls something else ({}): take another name",
                       fmt::join(kNamesOfTrial, ", ")));
  }
  if (others.contains(name)) {
    refuse(fmt::format("shares its name '{}' with another parameter of the program", name));
  }
}

/// Of a program nobody can ask what it would have done next in a log: only its whole runs tell.
void CheckMethodOfProgram(const Experiment& experiment, const std::string& path) {
  const sweep::CalibrationOptions& method = experiment.calibrate.method;
  const sweep::ShortHorizonOptions standard;
  const bool has_horizon = method.horizon.most_frames != standard.most_frames ||
                           method.horizon.phases != standard.phases ||
                           method.horizon.moved_m != standard.moved_m;
  if (has_horizon) {
    throw yaml::Error(fmt::format(
        "{}: calibrate.method.horizon predicts the next frames of a log, which rift cannot ask of "
        "a program: leave it out, its whole runs are fitted",
        path));
  }
  if (method.features.rounds > 0) {
    throw yaml::Error(fmt::format(
        "{}: calibrate.method.features.rounds is {}, and features are fitted by drives of "
        "rift's own simulator: leave it out, a program's whole runs are fitted",
        path, method.features.rounds));
  }
  if (method.runs > 0) return;
  throw yaml::Error(
      fmt::format("{}: calibrate.method.runs is 0, and a program is fitted by its whole runs: set "
                  "1 or more",
                  path));
}

/// A program's parameters are names of its own; a fit starts at what is known of them.
void ResolveProgram(Experiment& experiment, const std::string& path) {
  CheckMethodOfProgram(experiment, path);
  std::set<std::string> names;
  for (const Parameter& parameter : experiment.space.parameters) names.insert(parameter.Name());
  std::vector<FreeParameter> resolved;
  for (const FreeParameter& written : experiment.calibrate.fit.list) {
    for (FreeParameter& free : Expand(written, experiment.space)) {
      CheckNameOfProgram(free, names);
      names.insert(Parameter{.key = free.key}.Name());
      free.start = free.prior_sd > 0.0 ? free.prior_mean : 0.5 * (free.min + free.max);
      resolved.push_back(free);
    }
  }
  experiment.calibrate.fit.list = resolved;
}

}  // namespace

void ResolveCalibrate(Experiment& experiment, const std::string& path) {
  RequireSimulatorAndLogs(experiment, path);
  CheckHoldout(experiment, path);
  if (experiment.candidate.kind == CandidateKind::kProgram) {
    ResolveProgram(experiment, path);
    return;
  }
  const std::vector<std::string> keys = yaml::ListKeys(experiment);
  std::vector<FreeParameter> resolved;
  for (const FreeParameter& written : experiment.calibrate.fit.list) {
    for (FreeParameter& free : Expand(written, experiment.space)) {
      try {
        free.key = yaml::ResolveKey(free.key, keys);
      } catch (const yaml::Error& unknown) {
        throw yaml::Error(fmt::format("{}: calibrate.fit: {}", free.origin, unknown.what()));
      }
      if (!free.key.starts_with("simulation.") && !free.key.starts_with("trial.")) {
        throw yaml::Error(
            fmt::format("{}: calibrate.fit: {} is no parameter of the simulator; fit keys "
                        "of simulation or trial",
                        free.origin, free.key));
      }
      CheckIsNotInSpace(free, experiment.space);
      CheckIsNamedOnce(free, resolved);
      free.start = StartOf(free, experiment);
      resolved.push_back(free);
    }
  }
  experiment.calibrate.fit.list = resolved;
  TryFit(experiment);
}

}  // namespace rift::experiment
