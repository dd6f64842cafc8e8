// Which cause a run is told, just inside and just outside of each rule: one run, whose counts and
// limits are changed.
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <string>

#include "rift/trial/steering_check.hpp"
#include "rift/trial/steering_loop.hpp"
#include "support/inputs/fake_robot.hpp"
#include "trial/progress.hpp"
#include "trial/steering_bench.hpp"

namespace rift::trial {
namespace {

using std::numbers::pi;

/// A run that arrived, taken for one that did not.
TrialResult LateRun() {
  test::FakeRobotOptions options{
      .command_delay_s = 0.12, .sensing_delay_s = 0.10, .frame_period_s = 0.05};
  options.world_from_start = control::StartPose(kTask);
  test::FakeRobot robot(options);
  TrialResult result = RunTrial(robot, kTask, {}, {});
  REQUIRE(result.outcome == Outcome::kReached);
  result.outcome = Outcome::kTimedOut;
  return result;
}

SteeringCheck Check(const TrialResult& result, const control::NavigatorOptions& navigator = {}) {
  return CheckSteering(result, kTask, navigator, {}, kPrior);
}

bool Says(const SteeringCheck& check, const std::string& words) {
  for (const std::string& cause : check.causes) {
    if (cause.find(words) != std::string::npos) return true;
  }
  return false;
}

TEST_CASE("Refused poses and stale decisions explain a run from more than a fifth of all on") {
  TrialResult run = LateRun();
  run.poses_refused = 200;
  run.poses_believed = 800;
  CHECK_FALSE(Says(Check(run), "refused as jumps"));
  run.poses_refused = 201;
  CHECK(Says(Check(run), "20 % of the poses were refused as jumps (control.pose_gate)"));
  run.poses_refused = 500;
  run.poses_believed = 500;
  run.refused_moves = 200;
  CHECK_FALSE(Says(Check(run), "max_speed_mps"));
  run.refused_moves = 201;
  CHECK(Says(Check(run), "max_speed_mps"));
  CHECK_FALSE(Says(Check(run), "max_yaw_rate_rad_s"));
  run.refused_moves = 0;
  run.refused_turns = 200;
  CHECK_FALSE(Says(Check(run), "max_yaw_rate_rad_s"));
  run.refused_turns = 201;
  CHECK(Says(Check(run), "max_yaw_rate_rad_s"));

  run = LateRun();
  run.limits.decisions = 8000;
  run.stale_decisions = 2000;
  CHECK_FALSE(Says(Check(run), "decisions were zero power"));
  run.stale_decisions = 2001;
  CHECK(Says(Check(run), "20 % of the decisions were zero power"));
}

TEST_CASE("A steering is told to hardly settle below thirty degrees, and unstable below none") {
  const TrialResult run = LateRun();
  const SteeringCheck good = Check(run);
  // Of a gain alone: 90 degrees less the gain times the yaw rate and the delay.
  const auto with_margin = [&](double margin_deg) {
    control::NavigatorOptions navigator;
    navigator.w_min = 0.0;
    navigator.heading = {
        (90.0 - margin_deg) * pi / 180.0 / (good.model.yaw_rate_rad_s * good.delay_s), 0.0, 0.0};
    const SteeringCheck check = Check(run, navigator);
    CHECK(check.margins.phase_margin_deg == Approx(margin_deg).margin(1e-6));
    return check;
  };
  CHECK_FALSE(Says(with_margin(30.5), "the steering hardly settles"));
  CHECK(Says(with_margin(29.5), "the steering hardly settles"));
  CHECK(Says(with_margin(0.5), "the steering hardly settles"));
  CHECK(Says(with_margin(-0.5), "the steering is unstable"));
  // d times the yaw rate of w, 1.45, is more than 1.
  control::NavigatorOptions navigator;
  navigator.heading = {0.045, 0.0, 0.05};
  const SteeringCheck never = Check(run, navigator);
  CHECK(Says(never, "the steering is unstable: control.heading.p 0.045 and d 0.05 with "));
  CHECK(Says(never, " of w never fall below a gain of 1 (d times that is 1 or more), at "));
  CHECK(Says(never, "stable below 0 ms"));
}

TEST_CASE("The least steering is too coarse from a swing of 45 degrees or of half the radius on") {
  const TrialResult run = LateRun();
  const SteeringCheck good = Check(run);
  const double turn_rad_s_of_w = good.model.yaw_rate_rad_s;
  const auto is_coarse = [&](double swing_deg, double share_of_radius) {
    control::NavigatorOptions navigator;
    navigator.w_min = swing_deg * pi / 180.0 / (turn_rad_s_of_w * good.delay_s);
    navigator.w_max = 1.0;
    const double path_m = SwingOf(navigator, good.model, good.delay_s).path_m;
    navigator.reach_radius_m = path_m / share_of_radius;
    return Says(Check(run, navigator), "is too coarse");
  };
  CHECK_FALSE(is_coarse(44.5, 0.1));
  CHECK(is_coarse(45.5, 0.1));
  CHECK_FALSE(is_coarse(20.0, 0.495));
  CHECK(is_coarse(20.0, 0.505));
}

TEST_CASE("Proposals are tried five times, and a run that circled again is none that arrived") {
  int tries = 0;
  SteeringCheck endless;
  endless.proposals = {{"a", 1.0, 2.0}};
  TryProposals(endless, [&](const std::vector<KeyProposal>&) {
    TriedRun run;
    run.result.outcome = Outcome::kTimedOut;
    run.check.proposals = {{"a", 1.0, 3.0 + ++tries}};
    return run;
  });
  CHECK(tries == 5);
  CHECK(endless.failed_tries == 5);
  CHECK(endless.proposals.empty());

  for (const bool has_arrived : {true, false}) {
    for (const double turns : {0.0, 9.0}) {
      SteeringCheck check;
      check.has_arrived = has_arrived;
      check.proposals = {{"trial.timeout_s", 6.0, 20.0}, {"b", 1.0, 2.0}};
      TryProposals(check, [&](const std::vector<KeyProposal>&) {
        TriedRun run;
        run.result.start_s = 100.0;
        run.result.end_s = 107.0;
        run.result.outcome = Outcome::kReached;
        run.check.turns = turns;
        return run;
      });
      const bool is_taken = !has_arrived || turns == 0.0;
      INFO(has_arrived << " " << turns);
      CHECK(check.tried_s.has_value() == is_taken);
      CHECK(check.failed_tries == (is_taken ? 0u : 1u));
      CHECK(check.proposals.size() == (is_taken ? 2 : 0));
    }
  }
}

TEST_CASE("A longer time is not proposed for a run that was in time without it") {
  for (const double was_s : {6.9, 7.1}) {
    SteeringCheck check;
    check.proposals = {{"a", 1.0, 2.0}, {"trial.timeout_s", was_s, 20.0}, {"b", 9.0, 2.0}};
    TryProposals(check, [](const std::vector<KeyProposal>&) {
      TriedRun run;
      run.result.end_s = 7.0;
      run.result.outcome = Outcome::kReached;
      return run;
    });
    CHECK(check.proposals.size() == (was_s < 7.0 ? 3 : 2));
    CHECK(check.proposals[1].key == (was_s < 7.0 ? "trial.timeout_s" : "b"));
  }
}

TEST_CASE("Of the delay of the loop there counts what control.latency does not make up for") {
  const TrialResult run = LateRun();
  const double delay_s = Check(run).delay_s;
  REQUIRE(delay_s > 0.2);
  control::NavigatorOptions navigator;
  navigator.latency.delay_s = 0.1;
  CHECK(Check(run, navigator).delay_s == Approx(delay_s - 0.1));
  navigator.latency.delay_s = 1.0;
  CHECK(Check(run, navigator).delay_s == 0.0);
}

TEST_CASE("A least steering that swings the heading too far is lowered to a swing of 15 degrees") {
  const TrialResult run = LateRun();
  const SteeringCheck good = Check(run);
  control::NavigatorOptions navigator;
  navigator.w_min = 60.0 * pi / 180.0 / (good.model.yaw_rate_rad_s * good.delay_s);
  navigator.w_max = 1.0;
  navigator.reach_radius_m = 0.5;  // the path swings by far less
  const SteeringCheck check = Check(run, navigator);
  REQUIRE_FALSE(check.proposals.empty());
  CHECK(check.proposals[0].key == "control.w_min");
  CHECK(check.proposals[0].was == navigator.w_min);
  CHECK(check.proposals[0].value == Approx(0.25 * navigator.w_min).epsilon(0.05));  // two digits
}

TEST_CASE("A run that did not circle is astray from twice the length of its task on") {
  const TrialResult run = LateRun();
  const auto is_astray = [&](double share) {
    control::Task task = kTask;
    task.waypoints = {{.name = "a"}, {.name = "b", .x_m = 0.5 * share * Way_m(run.trajectory)}};
    return Says(CheckSteering(run, task, {}, {}, kPrior), "a waypoint counts as reached within");
  };
  REQUIRE(Check(run).circle_m > control::NavigatorOptions{}.reach_radius_m);
  CHECK(is_astray(0.99));
  CHECK_FALSE(is_astray(1.01));
}

/// One of the wheels is slower than the other.
class Pulling : public test::FakeRobot {
 public:
  Pulling(const test::FakeRobotOptions& options, double left_share, double right_share)
      : FakeRobot(options), left_share_(left_share), right_share_(right_share) {}
  void Command(const control::WheelPower& power) override {
    FakeRobot::Command({left_share_ * power.left, right_share_ * power.right});
  }

 private:
  double left_share_, right_share_;
};

TEST_CASE("A pull is told from a heading error of 45 degrees on, with its side, and by its limit") {
  for (const bool is_left : {true, false}) {
    control::Task task = kTask;
    for (control::Waypoint& waypoint : task.waypoints) {
      if (!is_left) continue;
      waypoint.y_m = -waypoint.y_m;
      if (waypoint.heading_deg) waypoint.heading_deg = -*waypoint.heading_deg;
    }
    test::FakeRobotOptions options{
        .command_delay_s = 0.1, .sensing_delay_s = 0.07, .frame_period_s = 0.05};
    options.world_from_start = control::StartPose(task.waypoints);
    Pulling robot(options, is_left ? 0.6 : 1.0, is_left ? 1.0 : 0.6);
    const TrialResult run = RunTrial(robot, task, {}, {});
    REQUIRE(run.outcome == Outcome::kTimedOut);
    const auto check = [&](const control::NavigatorOptions& navigator) {
      return CheckSteering(run, task, navigator, {}, kPrior);
    };
    const SteeringModel model = check({}).model;
    REQUIRE((model.pull_rad_s > 0.0) == is_left);
    control::NavigatorOptions navigator;
    const double hold_w = std::abs(model.pull_rad_s) * navigator.v_max / model.yaw_rate_rad_s;
    const std::string words = is_left ? "it pulls to the left by " : "it pulls to the right by ";
    navigator.heading = {hold_w / (44.5 * pi / 180.0), 0.0, 0.0};
    CHECK_FALSE(Says(check(navigator), words));
    navigator.heading.p = hold_w / (45.5 * pi / 180.0);
    CHECK(Says(check(navigator), words));
    CHECK(Says(check(navigator), "asks for that only at a heading error of 4"));
    navigator.heading.p = hold_w / (20.0 * pi / 180.0);
    navigator.w_max = 0.03;
    REQUIRE(hold_w > 0.03);
    CHECK(Says(check(navigator), ", and control.w_max allows 0.03"));
  }
}

}  // namespace
}  // namespace rift::trial
