#include "rift/sessions/drive/identification.hpp"

#include <algorithm>

namespace rift::sessions {
namespace {

control::Segment Straight(double way_m, double power) {
  return {.straight_m = way_m, .power = power};
}

control::Segment Spin(double turn_deg, double power) {
  return {.turn_deg = turn_deg, .power = power};
}

control::Segment Arc(double turn_deg, double power) {
  constexpr double kRadius_m = 0.12;
  return {.turn_deg = turn_deg, .radius_m = kRadius_m, .power = power};
}

/// Long enough to coast to rest and for the command after it to be told from the one before.
control::Segment Hold() { return {.hold_s = 1.0}; }

std::vector<control::Segment> Excitation() {
  return {// Supply, friction and delay: powers apart, up and down; the holds show how it coasts.
          Straight(0.20, 0.15), Hold(), Straight(-0.20, 0.20), Hold(),  //
          Straight(0.30, 0.30), Hold(), Straight(-0.30, 0.45),
          Hold(),  //
                   // Track, and the friction of what is dragged sideways.
          Spin(180, 0.15), Hold(), Spin(-180, 0.15), Hold(),  //
          Spin(360, 0.30), Hold(), Spin(-360, 0.30), Hold(),  //
                                                              // Left against right, under way.
          Arc(90, 0.20), Hold(), Arc(-90, 0.30), Hold(), Straight(-0.30, 0.25), Hold(),  //
          Arc(-90, 0.20), Hold(), Arc(90, 0.30), Hold(), Straight(-0.20, 0.20)};
}

/// Friction of gear and bearing grows with the motor: the figures are of the 3pi+, the default. A
/// wheel at rest is held by no less.
experiment::FreeParameter FrictionOf(const simulation::MotorOptions& motor) {
  const double scale = motor.StallTorque_nm() / simulation::MotorOptions{}.StallTorque_nm();
  double max_nm = std::max(0.003 * scale, 1.5 * motor.friction_torque_nm);
  max_nm = std::min(max_nm, motor.breakaway_torque_nm.value_or(max_nm));
  return {.key = "simulation.motor.friction_torque_nm",
          .min = 0.0,
          .max = max_nm,
          .prior_mean = std::min(0.0019 * scale, max_nm),
          .prior_sd = 0.0008 * scale};
}

/// Ranges and what is known beside the logs: configs/calibrate.yaml gives the reasons. Each range
/// holds the robot's own value, where the fit starts.
std::vector<experiment::FreeParameter> WhatIsFitted(const simulation::SimulationOptions& robot) {
  const auto free = [](const char* key, double start, double min, double max, double mean,
                       double sd) {
    return experiment::FreeParameter{.key = key,
                                     .min = std::min(min, start),
                                     .max = std::max(max, start),
                                     .prior_mean = mean,
                                     .prior_sd = sd};
  };
  const simulation::MotorOptions& motor = robot.motor;
  std::vector<experiment::FreeParameter> fit{
      free("simulation.link.delay_s", robot.link.delay_s, 0.0, 0.20, 0.05, 0.05),
      free("simulation.motor.supply_ratio", motor.supply_ratio, 0.6, 1.7, 1.2, 0.25),
      FrictionOf(motor), free("simulation.motor.mismatch", motor.mismatch, -0.10, 0.10, 0.0, 0.04),
      free("simulation.body.caster_mu", robot.body.caster_mu, 0.0, 0.5, 0.15, 0.1)};
  std::erase_if(fit, [](const auto& one) { return !(one.min < one.max); });  // no friction at all
  return fit;
}

}  // namespace

experiment::Experiment IdentificationDrive(experiment::Experiment experiment) {
  constexpr double kSettle_s = 1.0, kTimeout_s = 120.0;
  if (experiment.waypoints.size() > 1) experiment.waypoints.resize(1);
  experiment.program = {.rest_s = 1.5, .segments = Excitation()};
  experiment.trial.settle_s = std::max(experiment.trial.settle_s, kSettle_s);
  experiment.trial.timeout_s = std::max(experiment.trial.timeout_s, kTimeout_s);
  experiment.name += "_identify";
  return experiment;
}

experiment::Experiment IdentificationFit(experiment::Experiment logs) {
  logs.goal = experiment::Goal::kCalibrate;
  logs.calibrate.holdout.names.clear();
  // The motions are compared, step by step; a program has no task whose traits could be.
  logs.calibrate.method.runs = 0;
  std::vector<experiment::FreeParameter>& fit = logs.calibrate.fit.list;
  if (fit.empty()) fit = WhatIsFitted(logs.simulation);
  return logs;
}

}  // namespace rift::sessions
