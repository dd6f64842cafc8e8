#include "rift/sweep/calibrate/short_horizon.hpp"

#include <algorithm>
#include <stdexcept>

#include "rift/geometry/pose2.hpp"
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

double Latency_s(const simulation::MocapOptions& mocap) {
  return 0.5 * mocap.exposure_s + mocap.processing_s;
}

/// How long before its stamp a pose was captured, on average over turns that are not late: a host
/// works for a turn on a picture that the driver has held since the turn before, of the first frame
/// after that began. A host that is faster than the camera waits for each frame.
double StampAge_s(const simulation::MocapOptions& mocap) {
  if (!mocap.host_period_s || mocap.rate_hz == 0.0) return 0.0;
  const double turn_s = *mocap.host_period_s, frame_s = 1.0 / mocap.rate_hz;
  return Latency_s(mocap) + (turn_s < frame_s ? turn_s : 2.0 * turn_s - 0.5 * frame_s);
}

/// The simulated robot seen through the eyes of a log: it moves as it is told, and reports what the
/// real one reported. Its path has the times at which the log would have stamped it.
class RobotOfLog : public trial::Robot {
 public:
  RobotOfLog(const SimulatedTrial& trial, const Trajectory& log, double began_s)
      : robot_(trial.simulation, trial.start, trial.seed, trial.image),
        log_(log),
        began_s_(began_s),
        arrival_s_(trial.simulation.mocap.host_period_s ? 0.0 : Latency_s(trial.simulation.mocap)),
        stamp_age_s_(StampAge_s(trial.simulation.MocapOfSession())),
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
  void Command(const control::WheelPower& power) override { robot_.Command(power); }
  void Advance(double dt_s) override {
    robot_.Advance(dt_s);
    RecordTruth();
  }
  void Stop() noexcept override { robot_.Stop(); }

  const Trajectory& Path() const { return path_; }

 private:
  double ClockOf(size_t row) const { return log_.poses[row].t_s - began_s_; }

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
  double arrival_s_;
  double stamp_age_s_;
  Pose2 point_from_robot_;
  size_t next_ = 0;
  Trajectory path_;
};

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

size_t FirstMoving(const Trajectory& log, double moved_m) {
  size_t i = 0;
  const Eigen::Vector2d start = log.poses.front().Position();
  while (i < log.poses.size() && (log.poses[i].Position() - start).norm() < moved_m) ++i;
  return i;
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

}  // namespace

Trajectory Replay(const SimulatedTrial& trial, const Trajectory& log,
                  std::optional<double> began_s) {
  const double from_s = began_s.value_or(log.poses.front().t_s);
  RobotOfLog robot(trial, log, from_s);
  // The log alone says when it ends.
  trial::TrialOptions options = trial.trial;
  options.timeout_s = std::max(options.timeout_s, log.poses.back().t_s - from_s + 1.0);
  options.lost_after_s = kLongestGap_s;
  options.arena = {};
  trial::RunTrial(robot, trial.task, trial.control, options);
  return robot.Path();
}

std::vector<HorizonError> ShortHorizonErrors(const SimulatedTrial& trial, const Trajectory& log,
                                             const ShortHorizonOptions& options,
                                             std::optional<double> began_s) {
  if (!log.HasYaw()) throw std::invalid_argument("a replay needs the yaw of the log");
  std::vector<HorizonError> mean;
  SimulatedTrial phase = trial;
  phase.simulation.link.late_share = 0.0;  // a log tells itself when its robot heard something
  const double offset = statistics::CounterRandom(trial.seed, kOffsetStream).Uniform(0, 0);
  for (int i = 0; i < options.phases; ++i, ++phase.seed) {
    // Even phases: over drawn ones the mean would change by leaps with a delay. Each log has its
    // own offset, so that many logs see many phases.
    phase.simulation.link.poll_phase = (i + offset) / options.phases;
    const auto errors = ErrorsOf(PosesAt(Replay(phase, log, began_s), log), log, options);
    mean.resize(errors.size());
    for (size_t k = 0; k < mean.size(); ++k) {
      mean[k].from = errors[k].from;
      mean[k].frames = errors[k].frames;
      mean[k].ahead_m += errors[k].ahead_m / options.phases;
      mean[k].left_m += errors[k].left_m / options.phases;
      mean[k].turned_rad += errors[k].turned_rad / options.phases;
    }
  }
  return mean;
}

}  // namespace rift::sweep
