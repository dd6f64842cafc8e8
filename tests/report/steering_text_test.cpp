// What is said of a run's steering, beside checks and robots whose numbers are chosen.

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "rift/report/json/json.hpp"

namespace rift::report {
namespace {

using nlohmann::json;
using Lines = std::vector<std::string>;

/// A run in which the robot stands: nothing is told but by the prior.
trial::TrialResult Standing() {
  trial::TrialResult result;
  result.trajectory.poses = {{.t_s = 0.0, .x_m = 0.1, .y_m = 0.2, .yaw_rad = 0.0},
                             {.t_s = 1.0, .x_m = 0.1, .y_m = 0.2, .yaw_rad = 0.0}};
  result.limits.decisions = 1;
  return result;
}

experiment::Experiment OneLeg() {
  experiment::Experiment experiment;
  experiment.waypoints = {{.name = "start", .heading_deg = 0.0}, {.name = "goal", .x_m = 1.0}};
  return experiment;
}

TEST_CASE("Of a simulated robot the steering is that of its motors, wheels and link") {
  experiment::Experiment experiment = OneLeg();
  simulation::SimulationOptions& simulation = experiment.simulation;
  simulation.motor.no_load_rad_s = 30.0;
  simulation.motor.supply_ratio = 0.8;
  simulation.motor.lag_s = 0.011;
  simulation.body.wheel_radius_m = 0.02;
  simulation.body.track_m = 0.1;
  simulation.link.delay_s = 0.04;
  simulation.link.baud = 2000.0;
  simulation.link.poll_s = 0.06;
  const auto model = [&] {
    return SteeringOf(experiment, sweep::SimulatedRun{.result = Standing()}).model;
  };
  CHECK(model().speed_mps == Approx(0.8 * 30.0 * 0.02));
  CHECK(model().yaw_rate_rad_s == Approx(2.0 * 0.48 / 0.1));
  // A line of ten bytes of ten bits, and half a period in which nobody listens.
  CHECK(model().command_delay_s == Approx(0.04 + 0.05 + 0.03 + 0.011));
  simulation.link.baud = 0.0;
  CHECK(model().command_delay_s == Approx(0.04 + 0.03 + 0.011));
}

TEST_CASE("Of the real robot the steering is that of its odometry and of the measured link") {
  experiment::Experiment experiment = OneLeg();
  control::DiffDriveOptions& drive = experiment.hardware.odometry.drive;
  drive.full_power_speed_rad_s = 40.0;
  drive.wheel_radius_m = 0.03;
  drive.track_m = 0.2;
  experiment.hardware.stopping.delay_s = 0.123;
  hardware::DriveRun run;
  run.has_begun = true;
  run.trial = Standing();
  const trial::SteeringModel unmeasured = SteeringOf(experiment, run).model;
  CHECK(unmeasured.speed_mps == Approx(1.2));
  CHECK(unmeasured.yaw_rate_rad_s == Approx(12.0));
  CHECK(unmeasured.command_delay_s == 0.123);
  run.ping = {.protocol = hardware::Protocol::kFramed, .sent = 9, .answered = 9, .p50_s = 0.05};
  CHECK(SteeringOf(experiment, run).model.command_delay_s == Approx(0.025));
  run.dry_run = true;
  CHECK(SteeringOf(experiment, run).model.speed_mps == 0.0);
  run.dry_run = run.has_begun = false;
  CHECK(SteeringOf(experiment, run).model.speed_mps == 0.0);
}

/// Why a robot that stood under a small power did not move, by its motors.
std::string WhyItStood(const simulation::SimulationOptions& simulation) {
  experiment::Experiment experiment = OneLeg();
  experiment.simulation = simulation;
  sweep::SimulatedRun run{.result = Standing()};
  run.result.outcome = trial::Outcome::kTimedOut;
  for (int i = 0; i < 10; ++i) {
    run.result.trajectory.poses.push_back(run.result.trajectory.poses.back());
    run.result.trajectory.poses.back().t_s += 1.0;
    run.result.commands.push_back({1.0 * i, {0.05, 0.04}});
  }
  const std::vector<std::string> causes = SteeringOf(experiment, run).causes;
  REQUIRE(causes.size() == 1);
  return causes[0];
}

TEST_CASE("The power that turns a wheel is that of its friction on its surface, or its dead band") {
  using Catch::Matchers::Contains;
  simulation::SimulationOptions simulation;
  simulation.motor.breakaway_torque_nm = 0.0021;
  simulation.motor.stall_torque_nm = 0.02;
  simulation.motor.supply_ratio = 0.8;
  simulation.motor.dead_band = 0.1;
  simulation.terrain.surface = "mat";
  simulation.terrain.surfaces["mat"].rolling_resistance = 0.0;
  CHECK_THAT(WhyItStood(simulation), Contains("turn from 0.13 (simulation.motor: breakaway"));
  simulation.terrain.surface = "nowhere";
  CHECK_THAT(WhyItStood(simulation), Contains("turn from 0.13 (simulation.motor: breakaway"));
  // As much again by rolling resistance.
  simulation.terrain.surface = "mat";
  simulation.terrain.surfaces["mat"].rolling_resistance =
      0.0021 / (simulation.body.WeightOnWheel_n() * simulation.body.wheel_radius_m);
  CHECK_THAT(WhyItStood(simulation), Contains("turn from 0.26 (simulation.motor: breakaway"));
  simulation.motor.dead_band = 0.3;
  CHECK_THAT(WhyItStood(simulation), Contains("turn from 0.3 (simulation.motor.dead_band)"));
  simulation.motor.model = simulation::MotorModel::kServo;
  CHECK_THAT(WhyItStood(simulation), Contains("motors, battery, dead band, a link that loses") &&
                                         Contains("or a floor that holds it"));
}

trial::SteeringCheck Check() {
  trial::SteeringCheck check;
  check.turns = 1.25;
  check.r2 = 0.81;
  check.model = {0.48, 9.6, 0.031, 0.042, 0.053};
  check.delay_s = 0.064;
  check.margins = {7.5, 31.0, 0.27};
  check.circle_m = 0.086;
  check.swing = {M_PI / 6.0, 0.0097};
  check.causes = {"it is late"};
  check.proposals = {{"control.heading.p", 2.0, 1.5}, {"control.w_max", 0.5, 0.25}};
  return check;
}

TEST_CASE("Every number of a steering check has its own key, and angles are in degrees") {
  trial::SteeringCheck check = Check();
  json expected = json::parse(R"({
    "turns": 1.25, "identified": false, "r2": 0.81, "speed_mps": 0.48, "yaw_rate_rad_s": 9.6,
    "pose_age_s": 0.031, "command_delay_s": 0.042, "delay_s": 0.064, "crossover_rad_s": 7.5,
    "phase_margin_deg": 31.0, "longest_delay_s": 0.27, "circle_m": 0.086, "swing_m": 0.0097,
    "pull_rad_s": 0.053, "causes": ["it is late"], "tried_s": null,
    "proposals": [{"key": "control.heading.p", "was": 2.0, "value": 1.5},
                  {"key": "control.w_max", "was": 0.5, "value": 0.25}]})");
  json told = SteeringJson(check);
  CHECK(told["swing_deg"].get<double>() == Approx(30.0));
  told.erase("swing_deg");
  CHECK(told == expected);
  check.is_identified = true;
  check.tried_s = 12.5;
  CHECK(json(SteeringJson(check))["identified"] == true);
  CHECK(json(SteeringJson(check))["tried_s"] == 12.5);
  check.model.speed_mps = 0.0;
  CHECK(SteeringJson(check).is_null());
}

TEST_CASE("A run that circled is told with its cause, the limits that bound and what to try") {
  trial::SteeringCheck check = Check();
  trial::LimitCounts limits;
  limits.decisions = 200;
  limits.v_max = 50;
  limits.w_max = 151;
  limits.slew = 50;
  const std::string bound =
      "limits that bound, of 200 decisions: w_max 76 %, v_max 25 %, slew 25 %";
  CHECK(SteeringLines(check, limits) ==
        Lines{"it circled: 1.2 turns on the way to one waypoint", "why: it is late", bound,
              "try: --set control.heading.p=1.5 --set control.w_max=0.25 (by the robot's file, "
              "since this run does not show its steering; not tried)"});
  check.is_identified = true;
  check.tried_s = 12.34;
  check.turns = 0.99;
  CHECK(SteeringLines(check, {}) ==
        Lines{"why: it is late",
              "try: --set control.heading.p=1.5 --set control.w_max=0.25 (by the steering of this "
              "run; simulated so, the robot arrives after 12.3 s)"});
  check.proposals.clear();
  CHECK(SteeringLines(check, {.decisions = 3}) ==
        Lines{"why: it is late", "limits that bound, of 3 decisions: no limit"});
  check.failed_tries = 1;
  CHECK(SteeringLines(check, {}) ==
        Lines{"why: it is late",
              "nothing to try: 1 simulated runs with other gains and limits did not mend it"});
  check.causes.clear();
  check.turns = 1.0;
  CHECK(SteeringLines(check, limits) == Lines{"it circled: 1.0 turns on the way to one waypoint"});
}

}  // namespace
}  // namespace rift::report
