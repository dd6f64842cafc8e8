#include "fitted_simulator.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <stdexcept>
#include <utility>

#include "model.hpp"
#include "rift/experiment/program_parameters.hpp"
#include "rift/gap/likeness.hpp"
#include "rift/sweep/calibrate/repeated_trial.hpp"
#include "rift/sweep/falsify/doubts.hpp"

namespace rift::sweep {
namespace {

using trajectory::Trajectory;

constexpr size_t kPoints = 16;

/// x, y and time since the first point at u = 1/n, 2/n, ... 1, where u is the share of the path's
/// length, as it is for the gap.
using Points = Eigen::Matrix<double, 3, static_cast<int>(kPoints)>;

Points PointsOf(const Trajectory& path) {
  const auto& poses = path.poses;
  const double step_m = path.ArcLength_m() / static_cast<double>(kPoints);
  Points points;
  double passed_m = 0.0;
  size_t at = 1, k = 0;
  for (; at < poses.size(); ++at) {
    const double length_m = (poses[at].Position() - poses[at - 1].Position()).norm();
    for (; k + 1 < kPoints && static_cast<double>(k + 1) * step_m <= passed_m + length_m; ++k) {
      const double share =
          length_m > 0.0 ? (static_cast<double>(k + 1) * step_m - passed_m) / length_m : 0.0;
      const auto between = [share](double a, double b) { return a + share * (b - a); };
      points.col(static_cast<Eigen::Index>(k)) << between(poses[at - 1].x_m, poses[at].x_m),
          between(poses[at - 1].y_m, poses[at].y_m), between(poses[at - 1].t_s, poses[at].t_s);
    }
    passed_m += length_m;
  }
  for (; k < kPoints; ++k) {  // the end, whatever was rounded on the way
    points.col(static_cast<Eigen::Index>(k)) << poses.back().x_m, poses.back().y_m,
        poses.back().t_s;
  }
  points.row(2).array() -= double{points(2, 0)};
  return points;
}

/// A robot that never leaves the beginning of a log.
Points Standing(const Trajectory& log) {
  Points points = Points::Zero();
  points.row(0).setConstant(log.poses.front().x_m);
  points.row(1).setConstant(log.poses.front().y_m);
  return points;
}

Traits TraitsOfPath(const Trajectory& path, const gap::LikenessOptions& likeness) {
  constexpr double kLeastWeave_m = 1e-6;  // a simulator without noise may not weave at all
  const gap::PathTraits shape = gap::TraitsOf(path, likeness);
  const Eigen::Vector4d traits(std::log(std::max(kLeastWeave_m, shape.weave_m)),
                               std::log(shape.speed_mps), 0.0, 0.0);
  return traits.allFinite() ? Traits(traits) : Traits();
}

LogPrediction PredictionOf(const Trajectory& log, std::vector<Recording> runs,
                           const gap::LikenessOptions& likeness) {
  LogPrediction prediction;
  Points mean = Points::Zero();
  double paths = 0.0;
  std::vector<Traits> traits;
  for (Recording& run : runs) {
    if (!HasPath(run)) continue;
    mean += PointsOf(run.trajectory);
    paths += 1.0;
    if (run.status != TrialStatus::kOk) continue;
    traits.push_back(TraitsOfPath(run.trajectory, likeness));
    prediction.runs.push_back(std::move(run.trajectory));
  }
  const Points error = (paths > 0.0 ? Points(mean / paths) : Standing(log)) - PointsOf(log);
  prediction.motions = Eigen::Map<const Eigen::VectorXd>(error.data(), error.size());
  prediction.frames.assign(kPoints, 1);
  prediction.mean_traits = MeanTraits(traits);
  return prediction;
}

}  // namespace

CalibrationOptions OfWholeRuns(CalibrationOptions options) {
  // Runs with the same seeds have none of the leaps that a polled link makes.
  constexpr double kShareOfStep = 0.3;
  options.horizon = {.most_frames = 1, .phases = 0};
  options.step *= kShareOfStep;
  return options;
}

bool HasPath(const Recording& run) {
  if (run.trajectory.poses.size() < 2) return false;
  const double length_m = run.trajectory.ArcLength_m();
  return std::isfinite(length_m) && length_m > 0.0;
}

ProgramTwins::ProgramTwins(CandidateRuns& runs, std::vector<TrialRequest> requests,
                           const experiment::Experiment& experiment, std::string experiment_file,
                           Say say)
    : runs_(runs),
      requests_(std::move(requests)),
      experiment_(experiment),
      experiment_file_(std::move(experiment_file)),
      say_(std::move(say)) {}

/// A mistake in units or axes is in every run.
void ProgramTwins::SayDoubts(const Recording& run, const CalibrationLog& log) const {
  const Recording real{.source = log.name, .trajectory = log.log};
  for (const TrialDoubt& doubt : DoubtsOf(experiment_, run, real)) {
    say_(fmt::format("warning: SIM {} and REAL {}: {}", run.source, log.name, doubt.text));
  }
}

TrialRequest ProgramTwins::RequestOf(size_t log, const std::vector<double>& values,
                                     std::uint64_t seed) const {
  TrialRequest request = requests_[log];
  request.theta = experiment::WithFitted(std::move(request.theta), values);
  request.seed = *request.seed + seed;
  return request;
}

std::vector<LogPrediction> ProgramTwins::Predict(const std::vector<CalibrationLog>& logs,
                                                 const std::vector<double>& values,
                                                 const CalibrationOptions& options) {
  std::vector<TrialRequest> requests;
  for (size_t i = 0; i < logs.size(); ++i) {
    for (int run = 0; run < options.runs; ++run) {
      requests.push_back(RequestOf(i, values, static_cast<std::uint64_t>(run)));
    }
  }
  std::vector<Recording> recordings = runs_.Run(requests);
  const auto first = std::find_if(recordings.begin(), recordings.end(), HasPath);
  if (!has_run_ && first != recordings.end()) {
    has_run_ = true;
    SayDoubts(*first, logs[static_cast<size_t>((first - recordings.begin()) / options.runs)]);
  }
  if (!has_run_) {
    throw std::invalid_argument(
        fmt::format("{}: not one of {} runs of the program where the fit starts gives a path; the "
                    "first: {}",
                    experiment_file_, recordings.size(), recordings.front().reason));
  }
  std::vector<LogPrediction> predictions;
  auto next = std::make_move_iterator(recordings.begin());
  for (const CalibrationLog& log : logs) {
    predictions.push_back(PredictionOf(log.log, {next, next + options.runs}, experiment_.likeness));
    next += options.runs;
  }
  return predictions;
}

std::vector<Trajectory> ProgramTwins::LogsAt(const std::vector<CalibrationLog>& logs,
                                             const std::vector<double>& values, int repeat) {
  std::vector<Trajectory> paths(logs.size());
  std::vector<size_t> open;
  for (size_t i = 0; i < logs.size(); ++i) open.push_back(i);
  std::string reason;
  for (int i = 0; i < kMostTries && !open.empty(); ++i) {
    std::vector<TrialRequest> requests;
    for (const size_t log : open) {
      requests.push_back(RequestOf(log, values, 0));
      requests.back().seed = SeedInPlace(*requests_[log].seed, repeat, i);
    }
    std::vector<Recording> runs = runs_.Run(requests);
    std::vector<size_t> still_open;
    for (size_t k = 0; k < open.size(); ++k) {
      const bool is_path = HasPath(runs[k]);
      const bool is_meant = is_path && runs[k].status == TrialStatus::kOk &&
                            LengthByStrides_m(runs[k].trajectory) <= logs[open[k]].longest_m;
      if (!is_meant) still_open.push_back(open[k]);
      if (!is_path) reason = runs[k].reason;
      if (is_path) paths[open[k]] = std::move(runs[k].trajectory);
    }
    open = std::move(still_open);
  }
  for (size_t i = 0; i < logs.size(); ++i) {
    if (!paths[i].poses.empty()) continue;
    throw std::runtime_error(
        fmt::format("{}: none of {} runs of the program in the place of {} gives a path: {}",
                    experiment_file_, kMostTries, logs[i].name, reason));
  }
  return paths;
}

Traits ProgramTwins::TraitsOf(const Trajectory& path, size_t /*log*/,
                              const std::vector<double>& /*values*/) const {
  return TraitsOfPath(path, experiment_.likeness);
}

}  // namespace rift::sweep
