#include "rift/sweep/calibrate/short_horizon.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "errors.hpp"
#include "rift/geometry/pose2.hpp"
#include "rift/statistics/descriptive.hpp"
#include "rift/statistics/random.hpp"

namespace rift::sweep {
namespace {

using geometry::Pose2;
using trajectory::StampedPose;
using trajectory::Trajectory;

constexpr std::uint64_t kOffsetStream = 40;
/// How long the loop runs on after the last pose of the log has arrived.
constexpr double kRunOut_s = 0.1;
/// A log without a pose for longer ends there: its clock was set meanwhile, by years perhaps.
constexpr double kLongestGap_s = 60.0;
/// A robot that leaves so much later than its replay had no connection until then: two polls of the
/// authors' listener, and less than the 0.4 s by which their first late log is.
constexpr double kLate_s = 0.2;

double Latency_s(const simulation::MocapOptions& mocap) {
  return 0.5 * mocap.exposure_s + mocap.processing_s;
}

/// Mean time between two rows as they were stamped, without those before which rows are missing.
double Turn_s(const Trajectory& log) {
  std::vector<double> turns_s;
  for (size_t i = 1; i < log.poses.size(); ++i) {
    turns_s.push_back(log.poses[i].Stamp_s() - log.poses[i - 1].Stamp_s());
  }
  const double longest_s = 1.5 * statistics::Median(turns_s);
  std::erase_if(turns_s, [longest_s](double turn_s) { return turn_s > longest_s; });
  return statistics::Mean(turns_s);
}

/// A host that stamps a pose when it is done with the picture, as one sees in its log.
struct Host {
  double turn_s = 0.0;
  double stamp_age_s = 0.0;  ///< how long before its stamp a pose was captured, on average
};

/// It works for a turn on a picture that the driver has held since the turn before, of the first
/// frame after that began. A host that is faster than the camera waits for each frame.
Host HostOf(const Trajectory& log, const simulation::MocapOptions& mocap) {
  if (!mocap.host_period_s || mocap.rate_hz == 0.0) return {};
  const double frame_s = 1.0 / mocap.rate_hz;
  if (*mocap.host_period_s < frame_s) {
    return {*mocap.host_period_s, Latency_s(mocap) + *mocap.host_period_s};
  }
  const double turn_s = Turn_s(log);
  return {turn_s, Latency_s(mocap) + 2.0 * turn_s - 0.5 * frame_s};
}

/// The first pose comes after what is left of a turn, half of one on average, and a whole one.
double Began_s(const Trajectory& log, const Host& host) {
  return log.poses.front().Stamp_s() - 1.5 * host.turn_s;
}

/// The simulated robot seen through the eyes of a log: it moves as it is told, and reports what the
/// real one reported. Its path has the times at which the log would have stamped it.
class RobotOfLog : public trial::Robot {
 public:
  /// What is commanded before `hears_from_s` is lost.
  RobotOfLog(const SimulatedTrial& trial, const Trajectory& log, const Host& host, double began_s,
             double hears_from_s)
      : robot_(trial.simulation, trial.start, trial.seed, trial.image),
        log_(log),
        began_s_(began_s),
        hears_from_s_(hears_from_s),
        arrival_s_(trial.simulation.mocap.host_period_s ? 0.0 : Latency_s(trial.simulation.mocap)),
        stamp_age_s_(host.stamp_age_s),
        point_from_robot_{trial.simulation.mocap.tag_ahead_m, 0.0, 0.0} {
    RecordTruth();
  }

  trial::Sensed Sense() override {
    trial::Sensed sensed = robot_.Sense();
    const double seen_s = sensed.now_s - arrival_s_;
    while (next_ < log_.poses.size() && ClockOf(next_) <= seen_s) ++next_;
    sensed.pose.reset();
    if (next_ > 0) {
      sensed.pose = trial::PoseMeasurement{.captured_s = ClockOf(next_ - 1),
                                           .world_from_robot = log_.poses[next_ - 1].Planar()};
    }
    if (seen_s > ClockOf(log_.poses.size() - 1) + kRunOut_s) sensed.fault = "the log ends here";
    return sensed;
  }
  void Command(const control::WheelPower& power) override {
    if (Now_s() < hears_from_s_) return;
    if (!first_power_s_ && !(power == control::WheelPower{})) first_power_s_ = Now_s();
    robot_.Command(power);
  }
  void Advance(double dt_s) override {
    robot_.Advance(dt_s);
    RecordTruth();
  }
  void Stop() noexcept override { robot_.Stop(); }

  const Trajectory& Path() const { return path_; }
  /// When it was first told to drive; none: never.
  std::optional<double> FirstPower_s() const { return first_power_s_; }

 private:
  double Now_s() const { return robot_.Truth().t_s; }
  double ClockOf(size_t row) const { return log_.poses[row].Stamp_s() - began_s_; }

  void RecordTruth() {
    const simulation::TruePose truth = robot_.Truth();
    const Pose2 tag = truth.Planar() * point_from_robot_;
    path_.poses.push_back({.t_s = began_s_ + truth.t_s + stamp_age_s_,
                           .x_m = tag.x_m,
                           .y_m = tag.y_m,
                           .yaw_rad = tag.yaw_rad});
  }

  simulation::SimulatedRobot robot_;
  const Trajectory& log_;
  double began_s_;
  double hears_from_s_;
  std::optional<double> first_power_s_;
  double arrival_s_;
  double stamp_age_s_;
  Pose2 point_from_robot_;
  size_t next_ = 0;
  Trajectory path_;
};

size_t FirstMoving(const Trajectory& log, double moved_m) {
  size_t i = 0;
  const Eigen::Vector2d start = log.poses.front().Position();
  while (i < log.poses.size() && (log.poses[i].Position() - start).norm() < moved_m) ++i;
  return i;
}

/// When the robot had left where it stood; NaN: it never did.
double Left_s(const Trajectory& path) {
  constexpr double kLeft_m = 0.02;
  const size_t first = FirstMoving(path, kLeft_m);
  return first < path.poses.size() ? path.poses[first].t_s : StampedPose::kNotLogged;
}

/// Poses of a path at the times of a log, both in order of time; the last one beyond its end.
std::vector<Pose2> PosesAt(const Trajectory& path, const Trajectory& log) {
  std::vector<Pose2> poses;
  size_t i = 0;
  for (const StampedPose& row : log.poses) {
    while (i + 2 < path.poses.size() && path.poses[i + 1].t_s < row.t_s) ++i;
    const StampedPose &a = path.poses[i], &b = path.poses[std::min(i + 1, path.poses.size() - 1)];
    const double span_s = b.t_s - a.t_s;  // none of a robot that had arrived when it began
    const double share = span_s > 0.0 ? std::clamp((row.t_s - a.t_s) / span_s, 0.0, 1.0) : 0.0;
    poses.push_back({a.x_m + share * (b.x_m - a.x_m), a.y_m + share * (b.y_m - a.y_m),
                     a.yaw_rad + share * geometry::WrapToPi(b.yaw_rad - a.yaw_rad)});
  }
  return poses;
}

std::vector<HorizonError> ErrorsOf(const std::vector<Pose2>& replay, const Trajectory& log,
                                   const ShortHorizonOptions& options) {
  std::vector<HorizonError> errors;
  const size_t rows = log.poses.size();
  for (size_t i = FirstMoving(log, options.moved_m); i < rows; ++i) {
    for (int frames = 1; frames <= options.most_frames && i + frames < rows; ++frames) {
      const Pose2 logged =
          geometry::Inverse(log.poses[i].Planar()) * log.poses[i + frames].Planar();
      const Pose2 motion = geometry::Inverse(replay[i]) * replay[i + frames];
      errors.push_back({.from = i,
                        .frames = frames,
                        .ahead_m = motion.x_m - logged.x_m,
                        .left_m = motion.y_m - logged.y_m,
                        .turned_rad = geometry::WrapToPi(motion.yaw_rad - logged.yaw_rad)});
    }
  }
  return errors;
}

constexpr double kOutlier_sd = 3.0;
// Of a log without noise: beyond these nothing is likelier.
constexpr double kLeastScatter_m = 1e-5, kLeastScatter_rad = 1e-4;

/// Ahead and turned over one frame, which have errors of their own each; left is a part of both.
std::vector<double> FrameErrors(const std::vector<HorizonError>& errors,
                                double HorizonError::*channel) {
  std::vector<double> sizes;
  for (const HorizonError& error : errors) {
    if (error.frames == 1) sizes.push_back(std::abs(error.*channel));
  }
  return sizes;
}

/// How likely the log is with each phase, adding up to one: normal errors of the scatter about the
/// best phase, outliers in proportion (Huber 1964).
std::vector<double> LikelihoodOf(const std::vector<std::vector<HorizonError>>& of_phase) {
  std::vector<double> cost(of_phase.size(), 0.0);
  for (const auto& [channel, least] : {std::pair(&HorizonError::ahead_m, kLeastScatter_m),
                                       std::pair(&HorizonError::turned_rad, kLeastScatter_rad)}) {
    std::vector<std::vector<double>> sizes;
    double scatter = std::numeric_limits<double>::infinity();
    for (const std::vector<HorizonError>& errors : of_phase) {
      sizes.push_back(FrameErrors(errors, channel));
      if (sizes.back().empty()) continue;
      scatter =
          std::min(scatter, statistics::kSigmaOfMedianDeviation * statistics::Median(sizes.back()));
    }
    scatter = std::max(scatter, least);
    for (size_t k = 0; k < sizes.size(); ++k) {
      for (const double size : sizes[k]) cost[k] += std::pow(Huber(size / scatter, kOutlier_sd), 2);
    }
  }
  const double least_cost = *std::min_element(cost.begin(), cost.end());
  double sum = 0.0;
  for (double& one : cost) sum += one = std::exp(-0.5 * (one - least_cost));
  for (double& one : cost) one /= sum;
  return cost;
}

std::vector<HorizonError> WeightedMean(const std::vector<std::vector<HorizonError>>& of_phase,
                                       const std::vector<double>& weights) {
  std::vector<HorizonError> mean(of_phase.front().size());
  for (size_t k = 0; k < mean.size(); ++k) {
    mean[k].from = of_phase.front()[k].from;
    mean[k].frames = of_phase.front()[k].frames;
    for (size_t i = 0; i < of_phase.size(); ++i) {
      mean[k].ahead_m += weights[i] * of_phase[i][k].ahead_m;
      mean[k].left_m += weights[i] * of_phase[i][k].left_m;
      mean[k].turned_rad += weights[i] * of_phase[i][k].turned_rad;
    }
  }
  return mean;
}

}  // namespace

Trajectory Replay(const SimulatedTrial& trial, const Trajectory& log,
                  std::optional<double> began_s) {
  const Host host = HostOf(log, trial.simulation.MocapOfSession());
  const double from_s = began_s.value_or(Began_s(log, host));
  // The log alone says when it ends.
  trial::TrialOptions options = trial.trial;
  options.timeout_s = std::max(options.timeout_s, log.poses.back().Stamp_s() - from_s + 1.0);
  options.lost_after_s = kLongestGap_s;
  options.arena = {};
  const auto replay = [&](double hears_from_s) {
    RobotOfLog robot(trial, log, host, from_s, hears_from_s);
    trial::RunTrial(robot, trial.task, trial.control, options);
    return std::pair(robot.Path(), robot.FirstPower_s());
  };
  auto [path, first_power_s] = replay(0.0);
  const double late_s = Left_s(log) - Left_s(path);
  if (!first_power_s || !(late_s > kLate_s)) return path;
  return replay(*first_power_s + late_s - 0.5 * trial.simulation.link.poll_s).first;
}

std::vector<HorizonError> ShortHorizonErrors(const SimulatedTrial& trial, const Trajectory& log,
                                             const ShortHorizonOptions& options,
                                             std::optional<double> began_s) {
  if (!log.HasYaw()) throw std::invalid_argument("a replay needs the yaw of the log");
  std::vector<std::vector<HorizonError>> of_phase;
  SimulatedTrial phase = trial;
  phase.simulation.link.late_share = 0.0;  // a log tells itself when its robot heard something
  const double offset = statistics::CounterRandom(trial.seed, kOffsetStream).Uniform(0, 0);
  for (int i = 0; i < options.phases; ++i, ++phase.seed) {
    // Even phases: over drawn ones the mean would change by leaps with a delay. Each log has its
    // own offset, so that many logs see many phases.
    phase.simulation.link.poll_phase = (i + offset) / options.phases;
    of_phase.push_back(ErrorsOf(PosesAt(Replay(phase, log, began_s), log), log, options));
  }
  return WeightedMean(of_phase, LikelihoodOf(of_phase));
}

double WayRatio(const SimulatedTrial& trial, const Trajectory& log, std::optional<double> began_s) {
  const ShortHorizonOptions by_frame{.most_frames = 1, .phases = 1};
  std::vector<double> ratios;
  for (const HorizonError& error : ShortHorizonErrors(trial, log, by_frame, began_s)) {
    const Pose2 from = log.poses[error.from].Planar(), to = log.poses[error.from + 1].Planar();
    const double logged_m = (geometry::Inverse(from) * to).x_m;
    if (logged_m > 0.0) ratios.push_back(1.0 + error.ahead_m / logged_m);
  }
  return statistics::Median(std::move(ratios));
}

}  // namespace rift::sweep
