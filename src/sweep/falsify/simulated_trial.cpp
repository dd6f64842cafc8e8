#include "rift/sweep/falsify/simulated_trial.hpp"

namespace rift::sweep {
namespace {

/// The simulated robot, with its true path written down as it goes.
class WitnessedRobot : public trial::Robot {
 public:
  WitnessedRobot(simulation::SimulatedRobot& robot, trajectory::Trajectory& truth)
      : robot_(robot), truth_(truth) {
    Witness();
  }

  trial::Sensed Sense() override { return robot_.Sense(); }
  void Command(const control::WheelPower& power) override { robot_.Command(power); }
  void Advance(double dt_s) override {
    robot_.Advance(dt_s);
    Witness();
  }
  void Stop() noexcept override { robot_.Stop(); }

 private:
  void Witness() {
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
};

}  // namespace

SimulatedRun Simulate(const SimulatedTrial& trial) {
  SimulatedRun run;
  simulation::SimulatedRobot robot(trial.simulation, trial.start, trial.seed, trial.image);
  WitnessedRobot witnessed(robot, run.truth);
  run.result = trial::RunTrial(witnessed, trial.waypoints, trial.control, trial.trial);
  return run;
}

}  // namespace rift::sweep
