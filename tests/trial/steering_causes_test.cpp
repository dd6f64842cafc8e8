// What a run is told that stands, is refused its poses, or has nothing to tell, word for word.
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <string>

#include "rift/trial/steering_check.hpp"
#include "trial/steering_bench.hpp"

namespace rift::trial {
namespace {

using std::numbers::pi;

/// Six seconds in which the robot is seen at one place ten times a second, at these powers in the
/// last two of them and at full ones before.
TrialResult Standing(const control::WheelPower& last) {
  TrialResult result;
  result.outcome = Outcome::kTimedOut;
  result.pose_age_s = result.arrival_age_s = 0.25;
  for (int i = 0; i <= 60; ++i) {
    result.trajectory.poses.push_back({.t_s = 0.1 * i,
                                       .x_m = 0.0,
                                       .y_m = 0.0,
                                       .yaw_rad = 0.0,
                                       .target_x_m = 0.4,
                                       .target_y_m = 0.05});
    result.commands.push_back({0.1 * i, i < 40 ? control::WheelPower{1.0, 1.0} : last});
  }
  result.poses_believed = result.limits.decisions = 61;
  return result;
}

SteeringPrior PriorWith(double dead_band, double breakaway_power = 0.0) {
  return {kPrior.model, dead_band, breakaway_power};
}

/// NaN without a proposal for the key.
double ProposedFor(const SteeringCheck& check, const std::string& key) {
  for (const KeyProposal& proposal : check.proposals) {
    if (proposal.key == key) return proposal.value;
  }
  return std::nan("");
}

TEST_CASE("A robot that stands is told the largest power of the end and what should turn it") {
  const auto why = [](const control::WheelPower& power, const SteeringPrior& prior) {
    const SteeringCheck check = CheckSteering(Standing(power), kTask, {}, {}, prior);
    REQUIRE(check.causes.size() == 1);
    return check.causes[0];
  };
  const std::string floor =
      ", a link that loses the commands, or a floor that holds it (slope, obstacle, no grip, a "
      "caster that drags)";
  for (const control::WheelPower power :
       {control::WheelPower{-0.13, 0.05}, control::WheelPower{0.05, -0.13}}) {
    CHECK(why(power, PriorWith(0.0)) ==
          "it does not move: 0.000 m in the last 2.0 s, at powers up to 0.13: motors, battery, "
          "dead band" +
              floor);
    // Wheels turn evenly a fifth above what turns them at all: 0.12 and 0.144.
    CHECK(why(power, PriorWith(0.1)) ==
          "it does not move: 0.000 m in the last 2.0 s, at powers up to 0.13, and its wheels "
          "should turn from 0.1 (simulation.motor.dead_band): motors, battery" +
              floor);
    CHECK(why(power, PriorWith(0.1, 0.12)) ==
          "it does not move: 0.000 m in the last 2.0 s, at powers up to 0.13, and its wheels turn "
          "from 0.12 (simulation.motor: breakaway torque over stall torque and supply_ratio)");
  }
  CHECK(why({0.5, 0.5}, PriorWith(0.9)) ==
        "it does not move: 0.000 m in the last 2.0 s, at powers up to 0.50, and its wheels turn "
        "from 0.9 (simulation.motor.dead_band), evenly from 1.1: full power, 1, is too little for "
        "this motor and load");
}

TEST_CASE("Of a robot that stands speeds are proposed at which both wheels turn, and the time") {
  control::NavigatorOptions navigator;
  navigator.v_min = 0.05;
  navigator.v_max = 0.1;
  navigator.reach_radius_m = 0.4;  // no circle is too wide
  control::Task task = kTask;
  const auto check = [&](double w_min, double length_m) {
    navigator.w_min = w_min;
    task.waypoints = {{.name = "a"}, {.name = "b", .x_m = length_m}};
    return CheckSteering(Standing({0.05, 0.05}), task, navigator, {}, PriorWith(0.1));
  };
  const SteeringCheck strong = check(0.07, 1.0), weak = check(0.01, 1.0);
  CHECK(ProposedFor(strong, "control.v_min") == 0.17);  // dead band and least steering
  CHECK(ProposedFor(strong, "control.v_max") == 0.17);
  CHECK(ProposedFor(weak, "control.v_min") == 0.12);
  CHECK(ProposedFor(weak, "control.v_max") == 0.12);
  CHECK_FALSE(strong.is_identified);
  CHECK(strong.model.pose_age_s == 0.25);
  CHECK(strong.model.speed_mps == kSpeed_mps);
  // Twice 300 m at 0.17 of the speed of full power; what takes more than an hour is none.
  CHECK(ProposedFor(check(0.07, 300.0), "trial.timeout_s") == 3000.0);
  CHECK(std::isnan(ProposedFor(check(0.07, 400.0), "trial.timeout_s")));
}

TEST_CASE("What has no steering to tell, or a reason of its own, is not explained") {
  const TrialResult run = Standing({0.05, 0.05});
  const auto causes = [](const TrialResult& of, const control::Task& task = kTask) {
    return CheckSteering(of, task, {}, {}, kPrior).causes.size();
  };
  for (const Outcome outcome : {Outcome::kTimedOut, Outcome::kLeftArena, Outcome::kLost}) {
    TrialResult ended = run;
    ended.outcome = outcome;
    CHECK(causes(ended) == 1);
  }
  for (const Outcome outcome : {Outcome::kReached, Outcome::kFell, Outcome::kFault}) {
    TrialResult ended = run;
    ended.outcome = outcome;
    CHECK(causes(ended) == 0);
  }
  TrialResult other = run;
  other.limits.decisions = 0;
  CHECK(causes(other) == 0);
  other.stale_decisions = 1;
  CHECK(causes(other) == 1);
  other = run;
  other.trajectory.poses.resize(1);
  CHECK(causes(other) == 0);
  control::ProgramOptions program;
  program.segments = {{.straight_m = 0.1}};
  control::Task powers = kTask;
  powers.program = control::Program(program, {}, {});
  CHECK(causes(run, powers) == 0);
}

TEST_CASE("A run that neither stands nor comes nearer is told its margin and its circle") {
  TrialResult run = Standing({0.2, 0.2});
  run.pose_age_s = 0.1;
  for (size_t i = 0; i < run.trajectory.poses.size(); ++i) {
    trajectory::StampedPose& pose = run.trajectory.poses[i];
    pose.t_s = 0.125 * static_cast<double>(i);
    pose.x_m = i % 2 == 0 ? 0.0 : 0.05;  // strides of two rows: no way at all
    pose.target_x_m = 1.0;
    pose.target_y_m = 0.0;
  }
  control::Task task = kTask;
  task.waypoints = {{.name = "a"}, {.name = "b", .x_m = 1.0}};
  control::NavigatorOptions navigator;
  const auto cause = [&](double reach_m) {
    navigator.reach_radius_m = reach_m;
    const SteeringCheck check = CheckSteering(run, task, navigator, {}, kPrior);
    REQUIRE(check.causes.size() == 1);
    return check.causes[0];
  };
  // 1.206 m/s x 0.15 over 29.07 rad/s x 0.045 x pi / 2; 104.3 deg less 1.35 rad/s x 0.1 s.
  const std::string text =
      "it came no nearer, 1.00 m left, and no limit of the steering explains it: the phase margin "
      "is 97 deg, and the circle at a heading error of 90 deg, 0.088 m, ";
  CHECK(cause(0.05) == text + "is larger than control.reach_radius_m");
  CHECK(cause(0.1) == text + "lies within control.reach_radius_m");
}

TEST_CASE("Turns are counted from waypoint to waypoint, of either sense") {
  for (const double side : {1.0, -1.0}) {
    for (const bool along_x : {true, false}) {
      TrialResult run = Standing({0.2, 0.2});
      run.outcome = Outcome::kReached;
      for (size_t i = 0; i < run.trajectory.poses.size(); ++i) {
        trajectory::StampedPose& pose = run.trajectory.poses[i];
        const bool is_second = i >= 41;
        pose.yaw_rad = std::remainder(side * 0.1 * static_cast<double>(i), 2.0 * pi);
        pose.target_x_m = along_x && is_second ? 2.0 : 1.0;
        pose.target_y_m = !along_x && is_second ? 2.0 : 1.0;
      }
      INFO(side << " " << along_x);
      CHECK(CheckSteering(run, kTask, {}, {}, kPrior).turns ==
            Approx(40 * 0.1 / (2.0 * pi)));  // and 19 rows on the second leg
    }
  }
}

TEST_CASE("A gate is too narrow up to 1.5 times what the robot does, beyond it the poses jump") {
  TrialResult run = Standing({0.2, 0.2});
  run.poses_refused = 600;
  run.poses_believed = 400;
  const SteeringPrior prior{{1.0, 20.0, 0.0, 0.0}, 0.1};
  control::NavigatorOptions navigator;
  navigator.w_min = 0.05;
  navigator.w_max = 0.4;
  const auto found = [&](double proposed) {
    const SteeringCheck check = CheckSteering(run, kTask, navigator, {}, prior);
    CHECK_FALSE(check.is_identified);
    CHECK(check.proposals.size() == (proposed > 0.0 ? 1 : 0));
    if (!check.proposals.empty()) CHECK(check.proposals[0].value == proposed);
    REQUIRE(check.causes.size() == 1);
    return check.causes[0];
  };
  run.refused_moves = 410;
  run.refused_turns = 120;
  navigator.pose_gate.max_speed_mps = 0.44;  // v_max is 0.3
  CHECK(found(0.9) ==
        "41 % of the poses were refused as jumps beyond control.pose_gate.max_speed_mps 0.44 m/s, "
        "and the robot does 0.3 m/s");
  navigator.pose_gate.max_speed_mps = 0.46;
  CHECK(found(0.0) ==
        "41 % of the poses were refused as jumps beyond control.pose_gate.max_speed_mps 0.46 m/s, "
        "and the robot does no more than 0.3 m/s: the camera's poses jump");
  run.refused_moves = 120;
  run.refused_turns = 330;
  run.limits.largest_raw_w = 0.1;
  navigator.pose_gate.max_yaw_rate_rad_s = 2.9;
  CHECK(found(6.0) ==
        "33 % of the poses were refused as jumps beyond control.pose_gate.max_yaw_rate_rad_s 2.9 "
        "rad/s, and the robot does 2 rad/s");
  navigator.pose_gate.max_yaw_rate_rad_s = 3.1;
  CHECK(found(0.0) ==
        "33 % of the poses were refused as jumps beyond control.pose_gate.max_yaw_rate_rad_s 3.1 "
        "rad/s, and the robot does no more than 2 rad/s: the camera's poses jump");
  // What was asked for counts within its limits: 0.05 and 0.4.
  navigator.pose_gate.max_yaw_rate_rad_s = 1.0;
  run.limits.largest_raw_w = 0.01;
  found(3.0);
  run.limits.largest_raw_w = 0.9;
  found(24.0);
  run.refused_turns = 120;
  CHECK(found(0.0) == "60 % of the poses were refused as jumps (control.pose_gate)");
}

TEST_CASE("Stale decisions are told with the age of the poses, or with the pause between them") {
  TrialResult run = Standing({0.0, 0.0});
  run.stale_decisions = 700;
  TrialOptions options;
  const auto found = [&](double stale_s, size_t decisions) {
    options.pose_stale_s = stale_s;
    run.limits.decisions = decisions;
    return CheckSteering(run, kTask, {}, options, kPrior);
  };
  // Poses that are 0.25 s old come in every 0.1 s: one may be missing.
  const SteeringCheck slow = found(0.44, 300);
  REQUIRE_FALSE(slow.causes.empty());
  CHECK(slow.causes[0] ==
        "70 % of the decisions were zero power: poses are 0.25 s old when they come in, and "
        "trial.pose_stale_s is 0.44 s: make the camera faster, or this longer");
  CHECK(ProposedFor(slow, "trial.pose_stale_s") == 0.54);  // 1.2 x 0.45
  const SteeringCheck pauses = found(0.46, 300);
  REQUIRE_FALSE(pauses.causes.empty());
  CHECK(pauses.causes[0] ==
        "70 % of the decisions were zero power: poses are 0.25 s old when they come in, but then "
        "none came for so long that the last one was older than trial.pose_stale_s, 0.46 s");
  CHECK(std::isnan(ProposedFor(pauses, "trial.pose_stale_s")));
  CHECK(pauses.causes.size() == 1);
  CHECK(ProposedFor(found(0.448, 300), "trial.pose_stale_s") == 0.54);
  CHECK(std::isnan(ProposedFor(found(0.452, 300), "trial.pose_stale_s")));
  CHECK(found(0.44, 0).causes[0] ==
        "all 700 decisions were zero power: poses are 0.25 s old when they come in, and "
        "trial.pose_stale_s is 0.44 s: make the camera faster, or this longer");
  CHECK(found(0.46, 0).causes[0] ==
        "all 700 decisions were zero power: poses are 0.25 s old when they come in, but then none "
        "came for so long that the last one was older than trial.pose_stale_s, 0.46 s");
  // As many as those that drove, and whatever the clock begins with.
  CHECK_FALSE(found(0.46, 700).causes.empty());
  for (trajectory::StampedPose& pose : run.trajectory.poses) pose.t_s += 50.0;
  CHECK(std::isnan(ProposedFor(found(0.452, 300), "trial.pose_stale_s")));
  CHECK(ProposedFor(found(0.448, 300), "trial.pose_stale_s") == 0.54);
}

}  // namespace
}  // namespace rift::trial
