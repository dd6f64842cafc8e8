#include "rift/sweep/falsify/evaluator.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>
#include <stdexcept>

#include "program_side.hpp"
#include "rift/experiment/parameter.hpp"
#include "rift/experiment/path_template.hpp"
#include "rift/sweep/falsify/doubts.hpp"
#include "rift/sweep/falsify/result.hpp"
#include "rift/sweep/falsify/settings.hpp"
#include "rift/trajectory/frame_grid.hpp"
#include "rift/yaml/bind.hpp"
#include "rift/yaml/enum_name.hpp"
#include "simulated_recording.hpp"

namespace rift::sweep {
namespace {

using experiment::CandidateKind;
using experiment::ReferenceKind;

/// What is wrong with the paths of an experiment is said with its file.
template <class Call>
auto InFile(const std::string& experiment_file, Call&& call) {
  try {
    return call();
  } catch (const std::invalid_argument& error) {
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

/// How the logs of one side are read; `key` is its block in the experiment.
template <class Side>
trajectory::ReadOptions ReadOptionsOf(const Side& side, const std::string& key,
                                      const gap::GapOptions& gap) {
  return {side.format, side.columns, side.units, fmt::format("--set {}.columns=", key),
          gap.IsInSpace()};
}

bool Has(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

std::string InBraces(const std::set<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "{" : ", {") + name + "}";
  return text.empty() ? "nothing" : text;
}

/// One log under two settings would be counted twice.
void RefuseSharedLogs(const experiment::Experiment& experiment) {
  const std::vector<experiment::Parameter>& parameters = experiment.space.parameters;
  const auto is_continuous = [](const experiment::Parameter& parameter) {
    return parameter.IsContinuous();
  };
  if (std::any_of(parameters.begin(), parameters.end(), is_continuous)) return;
  std::map<std::pair<std::string, std::string>, experiment::Theta> seen;
  for (const experiment::Theta& theta : experiment::GridPoints(parameters)) {
    const std::string& trial = experiment.reference.trials.names.front();
    const auto fill = [&](const std::string& path) {
      return experiment::FillTemplate(path, parameters, theta, trial);
    };
    const auto [first, is_new] = seen.try_emplace(
        {fill(experiment.candidate.path.text), fill(experiment.reference.path.text)}, theta);
    if (is_new) continue;
    throw std::invalid_argument(fmt::format(
        "two settings name the same logs, {} and {}: give the path templates more digits ({})",
        SettingText(parameters, first->second), SettingText(parameters, theta),
        first->first.second));
  }
}

/// A gap in space needs heights on both sides, and has nothing to do with headings in the plane.
void CheckDimension(const experiment::Experiment& experiment) {
  if (!experiment.gap.IsInSpace()) return;
  const auto refuse = [](const std::string& why) {
    throw std::invalid_argument("gap.dimension is xyz, " + why);
  };
  if (experiment.candidate.kind == CandidateKind::kSimulation) {
    refuse(
        "and candidate.kind is simulation, a robot that drives on a floor: use logs or a program");
  }
  if (experiment.reference.kind == ReferenceKind::kPath) {
    refuse("and reference.kind is path, whose waypoints have no height: use logs or a program");
  }
  if (experiment.objective == experiment::Objective::kOdometry) {
    refuse("and objective is odometry, which is of wheels on a floor: leave one of them out");
  }
  if (experiment.reference.tag_offset_m != 0.0) {
    refuse(
        fmt::format("and reference.tag_offset_m is {:g}, which moves a path along its yaw in the "
                    "plane: log the point that is to be compared, and leave it out",
                    experiment.reference.tag_offset_m));
  }
}

/// What a template names is said now, before a folder is made.
void CheckTemplate(const experiment::Experiment& experiment, const experiment::PathTemplate& path,
                   const std::string& key) {
  experiment::Theta first;
  for (const experiment::Parameter& parameter : experiment.space.parameters) {
    first.push_back(parameter.levels.empty() ? experiment::NumberValue(parameter.min)
                                             : parameter.levels.front());
  }
  try {
    experiment::FillTemplate(path.text, experiment.space.parameters, first,
                             experiment.reference.trials.names.front());
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(fmt::format("{}: {}", key, error.what()));
  }
}

}  // namespace

void CheckPaths(const experiment::Experiment& experiment) {
  std::vector<std::string> names = experiment::TemplateNames(experiment.candidate.path.text);
  const std::vector<std::string> more = experiment::TemplateNames(experiment.reference.path.text);
  names.insert(names.end(), more.begin(), more.end());
  for (const experiment::Parameter& parameter : experiment.space.parameters) {
    if (Has(names, parameter.Name())) continue;
    throw std::invalid_argument(fmt::format(
        "{}space.{} is in neither candidate.path nor reference.path as {{{}}}: they name {}",
        parameter.origin.empty() ? "" : parameter.origin + ": ", parameter.key, parameter.Name(),
        InBraces({names.begin(), names.end()})));
  }
  if (experiment.reference.trials.names.size() > 1 && !Has(names, "trial")) {
    throw std::invalid_argument(
        "reference.trials asks for repeats, and no path names {trial} to tell them apart");
  }
  RefuseSharedLogs(experiment);
}

Evaluator::Evaluator(const experiment::Experiment& experiment, std::string experiment_file,
                     Inputs inputs)
    : experiment_(experiment),
      experiment_file_(std::move(experiment_file)),
      inputs_(std::move(inputs)),
      candidate_logs_(inputs_, {ReadOptionsOf(experiment.candidate, "candidate", experiment.gap),
                                0.0, "candidate.format", experiment.candidate.grid_fps}),
      reference_logs_(inputs_, {ReadOptionsOf(experiment.reference, "reference", experiment.gap),
                                experiment.reference.tag_offset_m, "reference.format",
                                experiment.reference.grid_fps}) {
  InFile(experiment_file_, [&] {
    trajectory::CheckColumns(ReadOptionsOf(experiment.candidate, "candidate", experiment.gap));
    trajectory::CheckColumns(ReadOptionsOf(experiment.reference, "reference", experiment.gap));
  });
  const bool candidate_is_logs = experiment.candidate.kind == CandidateKind::kLogs;
  const bool reference_is_logs = experiment.reference.kind == ReferenceKind::kLogs;
  if (candidate_is_logs) RequirePath(experiment.candidate.path, "candidate.path");
  if (reference_is_logs) RequirePath(experiment.reference.path, "reference.path");
  InFile(experiment_file_, [&] {
    if (candidate_is_logs) CheckTemplate(experiment, experiment.candidate.path, "candidate.path");
    if (reference_is_logs) CheckTemplate(experiment, experiment.reference.path, "reference.path");
  });
  if (candidate_is_logs && reference_is_logs) {
    InFile(experiment_file_, [&] { CheckPaths(experiment); });
  }
  InFile(experiment_file_, [&] {
    candidate_program_ =
        CandidateProgram(experiment,
                         {ReadOptionsOf(experiment.candidate, "candidate", experiment.gap), 0.0,
                          "candidate.format", experiment.candidate.grid_fps},
                         inputs_);
    reference_program_ = ReferenceProgram(
        experiment,
        {ReadOptionsOf(experiment.reference, "reference", experiment.gap),
         experiment.reference.tag_offset_m, "reference.format", experiment.reference.grid_fps},
        inputs_);
  });
  // What is wrong with the task is said now, not in trial 1.
  const bool is_simulated =
      experiment.candidate.kind == CandidateKind::kSimulation ||
      (candidate_is_logs && experiment.reference.kind == ReferenceKind::kNominal);
  if (is_simulated || (experiment.reference.kind == ReferenceKind::kPath && candidate_is_logs)) {
    TrialOf(experiment, {}, experiment.seed);
  } else if (experiment.reference.kind == ReferenceKind::kPath) {
    InFile(experiment_file_, [&] { experiment::TaskOf(experiment); });
  }
  const auto& surfaces = experiment.simulation.terrain.surfaces;
  may_have_pictures_ = std::any_of(surfaces.begin(), surfaces.end(),
                                   [](const auto& named) { return !named.second.image.empty(); });
  CheckKinds();
}

/// Which of objective, start, candidate and reference go together.
void Evaluator::CheckKinds() const {
  const experiment::Experiment& experiment = experiment_;
  InFile(experiment_file_, [&] { CheckDimension(experiment); });
  const bool reference_is_logs = experiment.reference.kind == ReferenceKind::kLogs;
  if (candidate_program_ && experiment.objective == experiment::Objective::kOdometry) {
    throw std::invalid_argument(fmt::format(
        "{}: objective is odometry, and a program (candidate.kind) has no encoders for rift",
        experiment_file_));
  }
  if (candidate_program_ && experiment.start == experiment::Start::kReference) {
    throw std::invalid_argument(
        fmt::format("{}: start is reference, and candidate.kind is program: rift does not place "
                    "somebody else's robot; leave start out",
                    experiment_file_));
  }
  if (experiment.objective == experiment::Objective::kOdometry && reference_is_logs) {
    throw std::invalid_argument(fmt::format(
        "{}: objective is odometry, which holds each run of the candidate against its own camera, "
        "and reference.kind is logs: name logs as candidate.path",
        experiment_file_));
  }
  if (experiment.start == experiment::Start::kReference && !reference_is_logs) {
    throw std::invalid_argument(fmt::format(
        "{}: start is reference, and reference.kind is {}: only logs tell where the robot stood",
        experiment_file_, yaml::NameOf(experiment.reference.kind)));
  }
}

void Evaluator::RequirePath(const experiment::PathTemplate& path, const std::string& key) const {
  if (!path.text.empty()) return;
  throw std::invalid_argument(
      fmt::format("{}: {} is missing: name the logs, such as {}: logs/{{surface}}_{{trial}}.csv",
                  experiment_file_, key, key));
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
  const experiment::Experiment at = ExperimentFor(experiment_, request);
  const bool starts_as_reference = experiment_.start == experiment::Start::kReference;
  const geometry::Pose2 start =
      starts_as_reference ? StartFromLog(reference.trajectory, experiment_.reference.tag_offset_m,
                                         at.simulation.mocap)
                          : experiment::TaskOf(at).Start();
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
  Recording simulated = RecordingOf(std::move(run), trial);
  const bool is_moved =
      experiment_.reference.kind == ReferenceKind::kLogs && simulated.status == TrialStatus::kOk;
  // The same point of the body on both sides.
  simulated.trajectory =
      trajectory::OnFramesOf(std::move(simulated.trajectory), experiment_.candidate.grid_fps);
  if (is_moved) {
    simulated.trajectory =
        trajectory::OffsetAlongHeading(simulated.trajectory, experiment_.reference.tag_offset_m);
  }
  return {std::move(simulated), std::move(encoders)};
}

std::vector<odometry::EncoderReading> Evaluator::EncodersBeside(const std::string& log) const {
  const std::string path = std::filesystem::path(log).replace_filename("encoders.csv").string();
  const std::optional<std::string> text = inputs_.read(path);
  if (!text) return {};
  return odometry::ReadEncoders(*text, path);
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
  return {.source = PathName(), .trajectory = IdealPathAt(request.theta)};
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
    if (run.encoders.size() < 2 || !run.camera.trajectory.HasYaw()) {
      wheels.status = TrialStatus::kUnreadable;
      wheels.reason = run.encoders.size() < 2
                          ? "objective: odometry needs encoders (encoders.csv beside the log)"
                          : "objective: odometry needs the yaw of the log";
    } else {
      const geometry::Pose2 start = trajectory::StandingPose(run.camera.trajectory);
      wheels.trajectory =
          odometry::OdometryPath(run.encoders, experiment_.hardware.odometry, start);
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

TrialRow Evaluator::EvaluateDriven(const TrialRequest& asked, const std::string& path,
                                   trial::Outcome outcome) {
  if (experiment_.objective == experiment::Objective::kOdometry) {
    throw std::invalid_argument(fmt::format(
        "{}: objective is odometry, and suggested drives are judged by the gap of their poses",
        experiment_file_));
  }
  RecordedLogs logs(inputs_,
                    {{.format = trajectory::Format::kRift}, 0.0, "the format of rift drive"});
  Recording driven = logs.At(path);
  if (driven.status == TrialStatus::kOk && outcome != trial::Outcome::kReached) {
    driven.status = StatusOf(outcome);
    driven.reason = "the robot did not reach the end";
  }
  TrialRequest request = asked;
  if (request.seed) request.seed = SeedWithReference(*request.seed);
  if (experiment_.reference.kind != ReferenceKind::kLogs) {
    return CompareTrial(experiment_, request, driven, Reference(request));
  }
  return CompareTrial(experiment_, request, Candidate(request, driven), driven);
}

double Evaluator::NoiseFloor_m(const experiment::Theta& theta, const std::function<bool()>& go_on) {
  const std::vector<std::string>& trials = experiment_.reference.trials.names;
  const bool has_repeats = trials.size() > 1 && !reference_program_ &&
                           experiment_.reference.kind != ReferenceKind::kPath;
  if (!has_repeats) return gap::kNotComputed;
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
  return found->second = gap::NoiseFloor_m(references, experiment_.gap);
}

}  // namespace rift::sweep
