#include "rift/sweep/falsify/evaluator.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <stdexcept>
#include <utility>

#include "experiment_sides.hpp"
#include "program_side.hpp"
#include "rift/experiment/path_template.hpp"
#include "rift/experiment/task.hpp"
#include "rift/odometry/program_runs.hpp"
#include "rift/odometry/readings_during.hpp"
#include "rift/sweep/falsify/compare_trial.hpp"
#include "rift/sweep/falsify/doubts.hpp"
#include "rift/sweep/falsify/result.hpp"
#include "rift/sweep/falsify/settings.hpp"
#include "rift/yaml/bind.hpp"
#include "simulated_recording.hpp"

namespace rift::sweep {
namespace {

using experiment::CandidateKind;
using experiment::ReferenceKind;

/// What is wrong with an experiment is said with its file, where it does not name its line.
template <class Call>
auto InFile(const std::string& experiment_file, Call&& call) {
  try {
    return call();
  } catch (const std::invalid_argument& error) {
    if (std::string_view(error.what()).starts_with(experiment_file + ':')) throw;
    throw std::invalid_argument(fmt::format("{}: {}", experiment_file, error.what()));
  }
}

/// A recorded run with what its controller must have asked for: the experiment's controller, with
/// those parameters of the setting that name its keys ("v_max"), over the logged poses.
Recording WithLimits(Recording log, const experiment::Experiment& experiment,
                     const TrialRequest& request, double tag_offset_m) {
  if (log.status != TrialStatus::kOk) return log;
  log.limits = RebuildLimits(log.trajectory, ControllerFor(experiment, request), tag_offset_m);
  return log;
}

/// What is read anew for each trial is noted once.
Inputs NotingOnce(Inputs inputs) {
  inputs.note = [note = std::move(inputs.note),
                 said = std::set<std::string>()](const std::string& line) mutable {
    if (said.insert(line).second) note(line);
  };
  return inputs;
}

/// How the logs of one side are read; `key` is its block in the experiment.
template <class Side>
LogOptions LogOptionsOf(const Side& side, const std::string& key, double tag_offset_m,
                        const gap::GapOptions& gap) {
  return {{side.format, side.columns, side.units, fmt::format("--set {}.columns=", key),
           gap.IsInSpace()},
          tag_offset_m,
          key + ".format",
          side.grid_fps};
}

LogOptions CandidateLogs(const experiment::Experiment& experiment) {
  return LogOptionsOf(experiment.candidate, "candidate", 0.0, experiment.gap);
}

LogOptions ReferenceLogs(const experiment::Experiment& experiment) {
  return LogOptionsOf(experiment.reference, "reference", experiment.reference.tag_offset_m,
                      experiment.gap);
}

/// The way of the tag of a robot that keeps to a program.
trajectory::Trajectory OfTag(trajectory::Trajectory program, double tag_ahead_m) {
  return trajectory::OffsetAlongHeading(odometry::OfAxle(std::move(program), tag_ahead_m),
                                        tag_ahead_m);
}

}  // namespace

Evaluator::Evaluator(const experiment::Experiment& experiment, std::string experiment_file,
                     Inputs inputs)
    : experiment_(experiment),
      experiment_file_(std::move(experiment_file)),
      inputs_(NotingOnce(std::move(inputs))),
      candidate_logs_(inputs_, CandidateLogs(experiment)),
      reference_logs_(inputs_, ReferenceLogs(experiment)) {
  InFile(experiment_file_, [&] {
    trajectory::CheckColumns(CandidateLogs(experiment).read);
    trajectory::CheckColumns(ReferenceLogs(experiment).read);
    CheckSides(experiment);
    candidate_program_ = CandidateProgram(experiment, CandidateLogs(experiment), inputs_);
    reference_program_ = ReferenceProgram(experiment, ReferenceLogs(experiment), inputs_);
  });
  CheckTask();
  const auto& surfaces = experiment.simulation.terrain.surfaces;
  may_have_pictures_ = std::any_of(surfaces.begin(), surfaces.end(),
                                   [](const auto& named) { return !named.second.image.empty(); });
}

/// What is wrong with the task is said now, not in trial 1.
void Evaluator::CheckTask() const {
  const bool candidate_is_logs = experiment_.candidate.kind == CandidateKind::kLogs;
  const bool is_simulated =
      experiment_.candidate.kind == CandidateKind::kSimulation ||
      (candidate_is_logs && experiment_.reference.kind == ReferenceKind::kNominal);
  if (is_simulated || (experiment_.reference.kind == ReferenceKind::kPath && candidate_is_logs)) {
    TrialOf(experiment_, {}, experiment_.seed);
  } else if (experiment_.reference.kind == ReferenceKind::kPath) {
    InFile(experiment_file_, [&] { experiment::TaskOf(experiment_); });
  }
}

std::string Evaluator::Filled(const experiment::PathTemplate& path,
                              const TrialRequest& request) const {
  return InFile(experiment_file_, [&] {
    return experiment::FillTemplate(path.text, experiment_.space.parameters, request.theta,
                                    request.trial);
  });
}

std::string Evaluator::ReferencePath(const TrialRequest& request) const {
  return Filled(experiment_.reference.path, request);
}

SimulatedTrial Evaluator::TrialOf(const experiment::Experiment& experiment,
                                  const geometry::Pose2& start, std::uint64_t seed) const {
  return SimulatedTrialOf(experiment, start, seed, experiment_file_, inputs_);
}

SimulatedTrial Evaluator::TrialFor(const TrialRequest& request, const Recording& reference) const {
  const experiment::Experiment at =
      experiment::DrawnAt(ExperimentFor(experiment_, request), *request.seed);
  const bool starts_as_reference = experiment_.start == experiment::Start::kReference;
  const geometry::Pose2 start =
      starts_as_reference ? StartFromLog(reference.trajectory, experiment_.reference.tag_offset_m,
                                         at.simulation.mocap)
                          : experiment::AxleAtStart(at);
  return TrialOf(at, start, *request.seed);
}

Recording Evaluator::Candidate(const TrialRequest& request, const Recording& reference) {
  return RunOf(request, reference).camera;
}

CandidateRun Evaluator::RunOf(const TrialRequest& request, const Recording& reference) {
  if (experiment_.candidate.kind == CandidateKind::kLogs) {
    const std::string path = Filled(experiment_.candidate.path, request);
    return {WithLimits(candidate_logs_.At(path), experiment_, request, 0.0), EncodersBeside(path)};
  }
  if (reference.status != TrialStatus::kOk) return {reference, {}};  // nothing to compare with
  if (candidate_program_) return {candidate_program_->Run(request), {}};
  const bool lacks_start =
      experiment_.start == experiment::Start::kReference && !reference.trajectory.HasYaw();
  if (lacks_start) {
    return {{.status = TrialStatus::kUnreadable,
             .reason = "start: reference needs its yaw: set reference.format",
             .source = reference.source},
            {}};
  }
  const SimulatedTrial trial = TrialFor(request, reference);
  SimulatedRun run = Simulate(trial);
  std::vector<odometry::EncoderReading> encoders = std::move(run.encoders);
  Recording simulated = RecordingOf(std::move(run), trial, experiment_.candidate.grid_fps);
  const bool is_moved =
      experiment_.reference.kind == ReferenceKind::kLogs && simulated.status == TrialStatus::kOk;
  // The same point of the body on both sides.
  if (is_moved) {
    simulated.trajectory =
        trajectory::OffsetAlongHeading(simulated.trajectory, experiment_.reference.tag_offset_m);
  }
  return {std::move(simulated), std::move(encoders)};
}

void Evaluator::NameSides(TrialRow& row) const {
  const std::uint64_t asked = row.seed.value_or(experiment_.seed);
  const auto known = used_.find(asked);
  const std::uint64_t seed = known == used_.end() ? asked : known->second;
  const std::string run =
      fmt::format("{} with seed {}", candidate_program_ ? "program" : "simulation", seed);
  row.candidate = experiment_.candidate.kind == CandidateKind::kLogs
                      ? Filled(experiment_.candidate.path, RequestOf(row))
                      : run;
  switch (experiment_.reference.kind) {
    case ReferenceKind::kLogs:
      row.reference = ReferencePath(RequestOf(row));
      return;
    case ReferenceKind::kNominal:
      row.reference = run;
      return;
    case ReferenceKind::kProgram:
      row.reference = fmt::format("program with seed {}", seed);
      return;
    case ReferenceKind::kPath:
      row.reference = PathName();
      return;
  }
}

std::string Evaluator::PathName() const {
  return experiment_.program.segments.empty() ? "waypoint path" : "program path";
}

Recording Evaluator::Reference(const TrialRequest& request) {
  switch (experiment_.reference.kind) {
    case ReferenceKind::kLogs:
      return WithLimits(reference_logs_.At(ReferencePath(request)), experiment_, request,
                        experiment_.reference.tag_offset_m);
    case ReferenceKind::kNominal:
      return Nominal(request.seed.value_or(experiment_.seed));
    case ReferenceKind::kProgram:
      return reference_program_->Run(request);
    case ReferenceKind::kPath:
      break;
  }
  trajectory::Trajectory path = IdealPathAt(request.theta);
  const bool is_program = !experiment_.program.segments.empty();
  if (is_program) path = OfTag(std::move(path), TagAhead_m(experiment_, request));
  return {.source = PathName(), .trajectory = std::move(path)};
}

trajectory::Trajectory Evaluator::IdealPathAt(const experiment::Theta& theta) const {
  return IdealPath(experiment::TaskOf(ExperimentFor(experiment_, {.theta = theta})));
}

/// The camera of a run is the truth that its odometry is held against.
TrialRow Evaluator::EvaluateOdometry(const TrialRequest& request) {
  CandidateRun run;
  try {
    run = RunOf(request, {});
  } catch (const yaml::Error& broken_rule) {
    run.camera = {
        .status = TrialStatus::kInvalid, .reason = broken_rule.what(), .source = "experiment"};
  }
  Recording wheels = run.camera;
  wheels.source += ", its encoders";
  if (run.camera.status == TrialStatus::kOk) {
    const std::vector<odometry::EncoderReading> during =
        odometry::ReadingsDuring(run.camera.trajectory, run.encoders);
    const char* missing = nullptr;
    if (run.encoders.size() < 2) {
      missing = "objective: odometry needs encoders (encoders.csv beside the log)";
    } else if (!run.camera.trajectory.HasYaw()) {
      missing = "objective: odometry needs the yaw of the log";
    } else if (during.size() < 2) {
      missing =
          "objective: odometry needs encoders on the clock of the log, and they share no time";
    }
    if (missing != nullptr) {
      wheels.status = TrialStatus::kUnreadable;
      wheels.reason = missing;
    } else {
      // The wheels move the axle, and the camera sees the tag.
      const double tag_ahead_m = TagAhead_m(experiment_, request);
      const geometry::Pose2 start =
          trajectory::StandingPose(run.camera.trajectory) * geometry::Pose2{-tag_ahead_m, 0.0, 0.0};
      wheels.trajectory = trajectory::OffsetAlongHeading(
          odometry::OdometryPath(during, experiment_.hardware.odometry, start), tag_ahead_m);
    }
  }
  return CompareTrial(experiment_, request, wheels, run.camera);
}

TrialRow Evaluator::Evaluate(const TrialRequest& asked) {
  if (experiment_.objective == experiment::Objective::kOdometry) return EvaluateOdometry(asked);
  TrialRequest request = asked;
  if (request.seed) request.seed = SeedWithReference(*request.seed);
  Recording reference{.source = PathName()};  // the only one that depends on the setting's values
  try {
    reference = Reference(request);
    const Recording candidate = Candidate(request, reference);
    TrialRow row = CompareTrial(experiment_, request, candidate, reference);
    if (row.IsOk()) row.doubts = DoubtsOf(experiment_, candidate, reference);
    return row;
  } catch (const yaml::Error& broken_rule) {
    const Recording none{
        .status = TrialStatus::kInvalid, .reason = broken_rule.what(), .source = "experiment"};
    return CompareTrial(experiment_, request, none, reference);
  }
}

double Evaluator::NoiseFloor_m(const experiment::Theta& theta, const std::function<bool()>& go_on) {
  const std::vector<std::string>& trials = experiment_.reference.trials.names;
  const bool is_one_run = experiment_.reference.kind == ReferenceKind::kPath ||
                          (experiment_.reference.kind == ReferenceKind::kNominal &&
                           experiment_.candidate.kind == CandidateKind::kLogs);  // without seeds
  if (trials.size() < 2 || reference_program_ || is_one_run) return gap::kNotComputed;
  std::set<std::string> sources;  // one path twice is no repeat
  if (experiment_.reference.kind == ReferenceKind::kLogs) {
    for (const std::string& trial : trials) sources.insert(ReferencePath({theta, trial}));
  }
  const auto [found, is_new] =
      noise_floors_m_.try_emplace(fmt::format("{}", fmt::join(sources, "\n")));
  if (!is_new) return found->second;
  if (experiment_.reference.kind == ReferenceKind::kNominal) {
    return found->second = NominalNoiseFloor_m(go_on);
  }
  std::vector<trajectory::Trajectory> references;
  for (const std::string& source : sources) {
    const Recording& log = reference_logs_.At(source);
    if (log.status == TrialStatus::kOk) references.push_back(log.trajectory);
  }
  const std::vector<std::optional<size_t>> copy_of = gap::CopiesAmong(references);
  std::vector<trajectory::Trajectory> distinct;
  for (size_t i = 0; i < references.size(); ++i) {
    if (!copy_of[i]) distinct.push_back(std::move(references[i]));
  }
  return found->second = gap::NoiseFloor_m(distinct, experiment_.gap);
}

}  // namespace rift::sweep
