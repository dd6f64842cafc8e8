#include "rift/sweep/falsify/simulated_trial.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "rift/simulation/terrain.hpp"
#include "rift/simulation/tilt_ambiguity.hpp"

namespace rift::sweep {

namespace {

/// The simulated robot, with its true path and its encoders written down as it goes.
class RobotWithTruth : public trial::Robot {
 public:
  RobotWithTruth(simulation::SimulatedRobot& robot, SimulatedRun& run)
      : robot_(robot), truth_(run.truth), encoders_(run.encoders) {
    RecordTruth();
  }

  trial::Sensed Sense() override {
    trial::Sensed sensed = robot_.Sense();
    const bool is_new = encoders_.empty() || sensed.now_s > encoders_.back().t_s;
    if (sensed.encoders && is_new) encoders_.push_back({sensed.now_s, *sensed.encoders});
    return sensed;
  }
  void Command(const control::WheelPower& power) override { robot_.Command(power); }
  void Advance(double dt_s) override {
    robot_.Advance(dt_s);
    RecordTruth();
  }
  void Stop() noexcept override { robot_.Stop(); }

 private:
  void RecordTruth() {
    const simulation::TruePose pose = robot_.Truth();
    const bool is_new = truth_.poses.empty() || pose.t_s > truth_.poses.back().t_s;
    if (!is_new) return;
    truth_.poses.push_back({.t_s = pose.t_s,
                            .x_m = pose.x_m,
                            .y_m = pose.y_m,
                            .z_m = pose.z_m,
                            .roll_rad = pose.roll_rad,
                            .pitch_rad = pose.pitch_rad,
                            .yaw_rad = pose.yaw_rad});
  }

  simulation::SimulatedRobot& robot_;
  trajectory::Trajectory& truth_;
  std::vector<odometry::EncoderReading>& encoders_;
};

std::shared_ptr<const simulation::HeightImage> ImageOf(const simulation::TerrainOptions& terrain,
                                                       const Inputs& inputs) {
  const simulation::SurfaceOptions& surface = terrain.Chosen();
  if (surface.shape != simulation::Shape::kHeightfield) return nullptr;
  const std::optional<std::string> bytes = inputs.read(surface.image);
  if (!bytes) {
    throw std::invalid_argument(
        fmt::format("cannot read {}: No such file or directory", surface.image));
  }
  try {
    return std::make_shared<const simulation::HeightImage>(simulation::DecodeHeightImage(*bytes));
  } catch (const std::exception& no_image) {
    throw std::invalid_argument(fmt::format("{}: {}", surface.image, no_image.what()));
  }
}

}  // namespace

SimulatedRun Simulate(const SimulatedTrial& trial) {
  SimulatedRun run;
  simulation::SimulatedRobot robot(trial.simulation, trial.start, trial.seed, trial.image);
  RobotWithTruth with_truth(robot, run);
  run.result = trial::RunTrial(with_truth, trial.task, trial.control, trial.trial);
  return run;
}

trajectory::Trajectory IdealPath(const control::Task& task) {
  trajectory::Trajectory path;
  for (const control::TimedPose& at : task.IdealPath()) {
    path.poses.push_back({.t_s = at.captured_s,
                          .x_m = at.world_from_robot.x_m,
                          .y_m = at.world_from_robot.y_m,
                          .yaw_rad = at.world_from_robot.yaw_rad});
  }
  return path;
}

SimulatedTrial SimulatedTrialOf(const experiment::Experiment& experiment,
                                const geometry::Pose2& start, std::uint64_t seed,
                                const std::string& experiment_file, const Inputs& inputs) {
  if (!experiment.ensemble.IsEmpty()) {
    return SimulatedTrialOf(experiment::DrawnAt(experiment, seed), start, seed, experiment_file,
                            inputs);
  }
  control::Task task;
  try {
    task = experiment::TaskOf(experiment);
  } catch (const std::invalid_argument& no_task) {
    throw std::invalid_argument(fmt::format("{}: {}", experiment_file, no_task.what()));
  }
  return {.task = std::move(task),
          .control = experiment.control,
          .trial = experiment.trial,
          .simulation = experiment.simulation,
          .start = start,
          .seed = seed,
          .image = ImageOf(experiment.simulation.terrain, inputs)};
}

geometry::Pose2 StartFromLog(const trajectory::Trajectory& log, double tag_offset_m,
                             const simulation::MocapOptions& mocap) {
  constexpr double kMirroredTilt_rad = 0.35;  // no ground that a robot starts on is steeper
  geometry::Pose2 world_from_point = trajectory::StandingPose(log);
  if (trajectory::StandingTilt_rad(log) > kMirroredTilt_rad) {
    world_from_point = simulation::LevelTag(mocap.ambiguity, world_from_point, mocap.tag_above_m);
  }
  const geometry::Pose2 point_from_robot{-(tag_offset_m + mocap.tag_ahead_m), 0.0, 0.0};
  return world_from_point * point_from_robot;
}

}  // namespace rift::sweep
