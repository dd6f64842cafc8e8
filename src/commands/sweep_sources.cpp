#include "sweep_sources.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "enum_name.hpp"
#include "rebuilt_limits.hpp"
#include "rift/sweep/path_template.hpp"
#include "simulated_runs.hpp"

namespace rift::commands {
namespace {

using sweep::CandidateKind;
using sweep::ReferenceKind;

/// The polyline through the waypoints, a second from each to the next.
trajectory::Trajectory WaypointPath(const std::vector<control::Waypoint>& waypoints) {
  trajectory::Trajectory path;
  for (size_t i = 0; i < waypoints.size(); ++i) {
    path.poses.push_back(
        {.t_s = static_cast<double>(i), .x_m = waypoints[i].x_m, .y_m = waypoints[i].y_m});
  }
  return path;
}

}  // namespace

SweepSources::SweepSources(const config::Experiment& experiment, std::string experiment_file)
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
    sweep::CheckPaths(Plan(), {experiment.candidate.path.text, experiment.reference.path.text});
  }
  if (!candidate_is_logs || !reference_is_logs) {
    TrialOf(experiment, {}, experiment.seed, experiment_file_);  // complains now, not in trial 1
  }
  if (experiment.start == sweep::Start::kReference && !reference_is_logs) {
    throw std::invalid_argument(fmt::format(
        "{}: start is reference, and reference.kind is {}: only logs tell where the robot stood",
        experiment_file_, NameOf(experiment.reference.kind)));
  }
}

void SweepSources::RequirePath(const sweep::PathTemplate& path, const std::string& key) const {
  if (!path.text.empty()) return;
  throw std::invalid_argument(
      fmt::format("{}: {} is missing: name the logs, such as {}: logs/{{surface}}_{{trial}}.csv",
                  experiment_file_, key, key));
}

sweep::GridPlan SweepSources::Plan() const {
  return {.name = experiment_.name,
          .candidate_kind = std::string(NameOf(experiment_.candidate.kind)),
          .reference_kind = std::string(NameOf(experiment_.reference.kind)),
          .parameters = experiment_.space.parameters,
          .trials = experiment_.reference.trials.names,
          .gap = experiment_.gap,
          .tag_offset_m = experiment_.reference.tag_offset_m};
}

/// Every setting meets the same random numbers (common random numbers), each repeat its own.
std::uint64_t SweepSources::SeedOf(const std::string& trial) const {
  const std::vector<std::string>& names = experiment_.reference.trials.names;
  const auto index = std::find(names.begin(), names.end(), trial) - names.begin();
  return experiment_.seed + static_cast<std::uint64_t>(index);
}

sweep::Recording SweepSources::Simulate(const config::Experiment& at, const std::string& trial,
                                        const geometry::Pose2& start) const {
  const std::uint64_t seed = SeedOf(trial);
  return RecordingOf(sweep::Simulate(TrialOf(at, start, seed, experiment_file_)), seed);
}

sweep::Recording SweepSources::Candidate(const sweep::Theta& theta, const std::string& trial,
                                         const sweep::Recording& reference) {
  if (experiment_.candidate.kind == CandidateKind::kLogs) {
    const std::string path = sweep::FillTemplate(experiment_.candidate.path.text,
                                                 experiment_.space.parameters, theta, trial);
    return WithLimits(candidate_logs_.At(path), experiment_, theta, 0.0);
  }
  const config::Experiment at = config::ExperimentAt(experiment_, theta);
  const double tag_offset_m = experiment_.reference.tag_offset_m;
  if (reference.status != sweep::TrialStatus::kOk) return reference;  // nothing to compare with
  const bool starts_as_reference = experiment_.start == sweep::Start::kReference;
  if (starts_as_reference && !reference.trajectory.HasYaw()) {
    return {.status = sweep::TrialStatus::kUnreadable,
            .reason = "start: reference needs its yaw: set reference.format",
            .source = reference.source};
  }
  const geometry::Pose2 start =
      starts_as_reference ? StartFromLog(reference.trajectory, tag_offset_m, at.simulation.mocap)
                          : control::StartPose(at.waypoints);
  sweep::Recording simulated = Simulate(at, trial, start);
  const bool is_moved = experiment_.reference.kind == ReferenceKind::kLogs &&
                        simulated.status == sweep::TrialStatus::kOk;
  // The same point of the body on both sides.
  if (is_moved) {
    simulated.trajectory = trajectory::OffsetAlongHeading(simulated.trajectory, tag_offset_m);
  }
  return simulated;
}

sweep::Recording SweepSources::Reference(const sweep::Theta& theta, const std::string& trial) {
  switch (experiment_.reference.kind) {
    case ReferenceKind::kLogs: {
      const std::string path = sweep::FillTemplate(experiment_.reference.path.text,
                                                   experiment_.space.parameters, theta, trial);
      return WithLimits(reference_logs_.At(path), experiment_, theta,
                        experiment_.reference.tag_offset_m);
    }
    case ReferenceKind::kNominal:
      return Simulate(experiment_, trial, control::StartPose(experiment_.waypoints));
    case ReferenceKind::kPath:
      break;
  }
  return {.source = "waypoint path", .trajectory = WaypointPath(experiment_.waypoints)};
}

std::string SweepSources::InputsText() const {
  return candidate_logs_.Hashes().Text() + reference_logs_.Hashes().Text();
}

}  // namespace rift::commands
