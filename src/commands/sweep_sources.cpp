#include "sweep_sources.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <set>
#include <stdexcept>

#include "rebuilt_limits.hpp"
#include "rift/experiment/parameter.hpp"
#include "rift/experiment/path_template.hpp"
#include "rift/yaml/enum_name.hpp"
#include "rift/yaml/error.hpp"
#include "simulated_runs.hpp"

namespace rift::commands {
namespace {

using experiment::CandidateKind;
using experiment::ReferenceKind;

/// The polyline through the waypoints, a second from each to the next.
trajectory::Trajectory WaypointPath(const std::vector<control::Waypoint>& waypoints) {
  trajectory::Trajectory path;
  for (size_t i = 0; i < waypoints.size(); ++i) {
    path.poses.push_back(
        {.t_s = static_cast<double>(i), .x_m = waypoints[i].x_m, .y_m = waypoints[i].y_m});
  }
  return path;
}

/// What is wrong with the paths of an experiment is said with its file.
template <class Call>
auto InFile(const std::string& experiment_file, Call&& call) {
  try {
    return call();
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(fmt::format("{}: {}", experiment_file, error.what()));
  }
}

}  // namespace

SweepSources::SweepSources(const experiment::Experiment& experiment, std::string experiment_file)
    : experiment_(experiment),
      experiment_file_(std::move(experiment_file)),
      candidate_logs_(experiment.candidate.format, 0.0, "candidate.format"),
      reference_logs_(experiment.reference.format, experiment.reference.tag_offset_m,
                      "reference.format") {
  const bool candidate_is_logs = experiment.candidate.kind == CandidateKind::kLogs;
  const bool reference_is_logs = experiment.reference.kind == ReferenceKind::kLogs;
  if (candidate_is_logs) RequirePath(experiment.candidate.path, "candidate.path");
  if (reference_is_logs) RequirePath(experiment.reference.path, "reference.path");
  if (candidate_is_logs && reference_is_logs) {
    InFile(experiment_file_, [&] {
      sweep::CheckPaths(Plan(), {experiment.candidate.path.text, experiment.reference.path.text});
    });
  }
  if (!candidate_is_logs || !reference_is_logs) {
    TrialOf(experiment, {}, experiment.seed, experiment_file_);  // complains now, not in trial 1
  }
  if (experiment.start == experiment::Start::kReference && !reference_is_logs) {
    throw std::invalid_argument(fmt::format(
        "{}: start is reference, and reference.kind is {}: only logs tell where the robot stood",
        experiment_file_, yaml::NameOf(experiment.reference.kind)));
  }
}

void SweepSources::RequirePath(const experiment::PathTemplate& path, const std::string& key) const {
  if (!path.text.empty()) return;
  throw std::invalid_argument(
      fmt::format("{}: {} is missing: name the logs, such as {}: logs/{{surface}}_{{trial}}.csv",
                  experiment_file_, key, key));
}

sweep::GridPlan SweepSources::Plan() const {
  return {.name = experiment_.name,
          .candidate_kind = std::string(yaml::NameOf(experiment_.candidate.kind)),
          .reference_kind = std::string(yaml::NameOf(experiment_.reference.kind)),
          .parameters = experiment_.space.parameters,
          .trials = experiment_.reference.trials.names,
          .seed = experiment_.candidate.kind == CandidateKind::kSimulation
                      ? std::optional(experiment_.seed)
                      : std::nullopt,
          .gap = experiment_.gap,
          .tag_offset_m = experiment_.reference.tag_offset_m,
          .falls_count = experiment_.falsify.falls_count};
}

std::string SweepSources::Filled(const experiment::PathTemplate& path,
                                 const experiment::Theta& theta, const std::string& trial) const {
  return InFile(experiment_file_, [&] {
    return experiment::FillTemplate(path.text, experiment_.space.parameters, theta, trial);
  });
}

std::string SweepSources::ReferencePath(const experiment::Theta& theta,
                                        const std::string& trial) const {
  return Filled(experiment_.reference.path, theta, trial);
}

sweep::SimulatedTrial SweepSources::TrialFor(const sweep::TrialRequest& request,
                                             const sweep::Recording& reference) const {
  const experiment::Experiment at = experiment::ExperimentAt(experiment_, request.theta);
  const bool starts_as_reference = experiment_.start == experiment::Start::kReference;
  const geometry::Pose2 start =
      starts_as_reference ? StartFromLog(reference.trajectory, experiment_.reference.tag_offset_m,
                                         at.simulation.mocap)
                          : control::StartPose(at.waypoints);
  return TrialOf(at, start, *request.seed, experiment_file_);
}

sweep::Recording SweepSources::Candidate(const sweep::TrialRequest& request,
                                         const sweep::Recording& reference) {
  if (experiment_.candidate.kind == CandidateKind::kLogs) {
    const std::string path = Filled(experiment_.candidate.path, request.theta, request.trial);
    return WithLimits(candidate_logs_.At(path), experiment_, request.theta, 0.0);
  }
  if (reference.status != sweep::TrialStatus::kOk) return reference;  // nothing to compare with
  const bool lacks_start =
      experiment_.start == experiment::Start::kReference && !reference.trajectory.HasYaw();
  if (lacks_start) {
    return {.status = sweep::TrialStatus::kUnreadable,
            .reason = "start: reference needs its yaw: set reference.format",
            .source = reference.source};
  }
  sweep::Recording simulated =
      RecordingOf(sweep::Simulate(TrialFor(request, reference)), *request.seed);
  const bool is_moved = experiment_.reference.kind == ReferenceKind::kLogs &&
                        simulated.status == sweep::TrialStatus::kOk;
  // The same point of the body on both sides.
  if (is_moved) {
    simulated.trajectory =
        trajectory::OffsetAlongHeading(simulated.trajectory, experiment_.reference.tag_offset_m);
  }
  return simulated;
}

/// The nominal run depends on the trial alone, and every setting is held against it.
const sweep::Recording& SweepSources::Nominal(const sweep::TrialRequest& request) {
  constexpr size_t kMostKept = 1000;
  const std::uint64_t seed = request.seed.value_or(experiment_.seed);
  const auto found = nominal_runs_.find(seed);
  if (found != nominal_runs_.end()) return found->second;
  if (nominal_runs_.size() >= kMostKept) nominal_runs_.clear();
  const geometry::Pose2 start = control::StartPose(experiment_.waypoints);
  const sweep::SimulatedTrial trial = TrialOf(experiment_, start, seed, experiment_file_);
  return nominal_runs_[seed] = RecordingOf(sweep::Simulate(trial), seed);
}

sweep::Recording SweepSources::Reference(const sweep::TrialRequest& request) {
  switch (experiment_.reference.kind) {
    case ReferenceKind::kLogs:
      return WithLimits(reference_logs_.At(ReferencePath(request.theta, request.trial)),
                        experiment_, request.theta, experiment_.reference.tag_offset_m);
    case ReferenceKind::kNominal:
      return Nominal(request);
    case ReferenceKind::kPath:
      break;
  }
  return {.source = "waypoint path", .trajectory = WaypointPath(experiment_.waypoints)};
}

sweep::TrialRow SweepSources::Evaluate(const sweep::TrialRequest& request) {
  const auto reference = [this](const sweep::TrialRequest& of) { return Reference(of); };
  const auto candidate = [this](const sweep::TrialRequest& of, const sweep::Recording& real) {
    try {
      return Candidate(of, real);
    } catch (const yaml::Error& broken_rule) {
      return sweep::Recording{.status = sweep::TrialStatus::kInvalid,
                              .reason = broken_rule.what(),
                              .source = "experiment"};
    }
  };
  return sweep::CompareTrial(Plan(), request, candidate, reference);
}

double SweepSources::NominalNoiseFloor_m() {
  const auto floor_m = [this](const std::string&) {
    std::vector<trajectory::Trajectory> runs;
    for (const sweep::TrialRequest& request : sweep::TrialsAt(Plan(), {})) {
      const sweep::Recording& run = Nominal(request);
      if (run.status == sweep::TrialStatus::kOk) runs.push_back(run.trajectory);
    }
    return fmt::format("{}", gap::NoiseFloor_m(runs, experiment_.gap));
  };
  double result_m = gap::kNotComputed;
  sweep::RunOptions options = experiment_.run;
  options.timeout_s *= static_cast<double>(experiment_.reference.trials.names.size());
  sweep::WorkerPool(floor_m, 1, options)
      .Run({1, [](int) { return std::string(); },
            [&](int, const sweep::JobResult& result) {
              if (result.end == sweep::JobEnd::kDone)
                result_m = std::strtod(result.bytes.c_str(), nullptr);
            },
            [] { return true; }});
  return result_m;
}

double SweepSources::NoiseFloor_m(const experiment::Theta& theta) {
  const std::vector<std::string>& trials = experiment_.reference.trials.names;
  const bool has_repeats = trials.size() > 1 && experiment_.reference.kind != ReferenceKind::kPath;
  if (!has_repeats) return gap::kNotComputed;
  std::set<std::string> sources;  // one path twice is no repeat
  if (experiment_.reference.kind == ReferenceKind::kLogs) {
    for (const std::string& trial : trials) sources.insert(ReferencePath(theta, trial));
  }
  const auto [found, is_new] =
      noise_floors_m_.try_emplace(fmt::format("{}", fmt::join(sources, "\n")));
  if (!is_new) return found->second;
  if (experiment_.reference.kind == ReferenceKind::kNominal) {
    return found->second = NominalNoiseFloor_m();
  }
  std::vector<trajectory::Trajectory> references;
  for (const std::string& source : sources) {
    const sweep::Recording& log = reference_logs_.At(source);
    if (log.status == sweep::TrialStatus::kOk) references.push_back(log.trajectory);
  }
  return found->second = gap::NoiseFloor_m(references, experiment_.gap);
}

void SweepSources::LoadLogs() {
  if (experiment_.reference.kind != ReferenceKind::kLogs) return;
  const std::vector<std::string> names = experiment::TemplateNames(experiment_.reference.path.text);
  // Of the other parameters one value will do: the path is the same for all.
  std::vector<experiment::Parameter> parameters = experiment_.space.parameters;
  for (experiment::Parameter& parameter : parameters) {
    const bool is_named = std::find(names.begin(), names.end(), parameter.Name()) != names.end();
    if (is_named && parameter.IsContinuous()) {
      throw std::invalid_argument(
          fmt::format("{}: space.{} is a range, and reference.path names a log for each value of "
                      "it: write a list of those there are",
                      parameter.origin, parameter.key));
    }
    if (!is_named) parameter.levels = {{"0", 0.0}};
  }
  for (const experiment::Theta& theta : experiment::GridPoints(parameters)) {
    for (const std::string& trial : experiment_.reference.trials.names) {
      reference_logs_.At(ReferencePath(theta, trial));
    }
  }
}

std::string SweepSources::KeyOf(const sweep::TrialRequest& request) const {
  std::string key;
  for (size_t i = 0; i < request.theta.size(); ++i) {
    const experiment::ParameterValue& value = request.theta[i];
    key += fmt::format("{}={} ", experiment_.space.parameters[i].key,
                       value.number ? fmt::format("{}", *value.number) : value.text);
  }
  key += fmt::format("trial={} seed={}", request.trial, request.seed.value_or(0));
  if (experiment_.reference.kind == ReferenceKind::kLogs) {
    const std::string path = ReferencePath(request.theta, request.trial);
    key += fmt::format(" log={}", reference_logs_.Hashes().Of(path));
  }
  return key;
}

std::string SweepSources::InputsText() const {
  return candidate_logs_.Hashes().Text() + reference_logs_.Hashes().Text();
}

}  // namespace rift::commands
