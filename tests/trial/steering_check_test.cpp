// Why a robot circles: its steering identified from the run, margins in closed form, and gains by
// which the same robot arrives.
#include "rift/trial/steering_check.hpp"

#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <deque>
#include <numbers>
#include <random>
#include <string>

#include "rift/geometry/pose2.hpp"
#include "support/inputs/fake_robot.hpp"
#include "support/pinned.hpp"
#include "trial/steering_bench.hpp"

namespace rift::trial {
namespace {

using control::NavigatorOptions;
using std::numbers::pi;

struct Bench {
  test::FakeRobotOptions robot;
  NavigatorOptions navigator;
  TrialOptions options;

  TrialResult Run() const {
    test::FakeRobotOptions at_start = robot;
    at_start.world_from_start = control::StartPose(kTask);
    test::FakeRobot fake(at_start);
    return RunTrial(fake, kTask, navigator, options);
  }
  SteeringCheck Check(const TrialResult& result) const {
    return CheckSteering(result, kTask, navigator, options, kPrior);
  }
  void Set(const std::vector<KeyProposal>& proposals) {
    for (const KeyProposal& proposal : proposals) {
      const std::string& key = proposal.key;
      double* value =
          key == "control.heading.p"                      ? &navigator.heading.p
          : key == "control.heading.i"                    ? &navigator.heading.i
          : key == "control.heading.d"                    ? &navigator.heading.d
          : key == "control.distance.p"                   ? &navigator.distance.p
          : key == "control.w_min"                        ? &navigator.w_min
          : key == "control.w_max"                        ? &navigator.w_max
          : key == "control.v_min"                        ? &navigator.v_min
          : key == "control.v_max"                        ? &navigator.v_max
          : key == "control.reach_radius_m"               ? &navigator.reach_radius_m
          : key == "trial.timeout_s"                      ? &options.timeout_s
          : key == "trial.pose_stale_s"                   ? &options.pose_stale_s
          : key == "control.pose_gate.max_speed_mps"      ? &navigator.pose_gate.max_speed_mps
          : key == "control.pose_gate.max_yaw_rate_rad_s" ? &navigator.pose_gate.max_yaw_rate_rad_s
                                                          : nullptr;
      INFO(key);
      REQUIRE(value != nullptr);
      CHECK(*value == proposal.was);
      *value = proposal.value;
    }
  }
};

std::string Joined(const SteeringCheck& check) {
  std::string text;
  for (const std::string& cause : check.causes) text += cause + "\n";
  for (const KeyProposal& proposal : check.proposals) {
    text += proposal.key + " " + std::to_string(proposal.value) + "\n";
  }
  return text;
}

/// NaN when there is no proposal for the key.
double ProposedFor(const SteeringCheck& check, const std::string& key) {
  for (const KeyProposal& proposal : check.proposals) {
    if (proposal.key == key) return proposal.value;
  }
  return std::nan("");
}

/// The largest error over the last second of twenty of a PID on an integrator with a delay, by
/// steps of a millisecond; it began at 1.
double ErrorAfter20s(const control::PidGains& gains, double yaw_rate_rad_s, double delay_s) {
  constexpr double kStep_s = 1e-3;
  std::deque<double> outputs(static_cast<size_t>(std::llround(delay_s / kStep_s)), 0.0);
  double error = 1.0, before = 1.0, integral = 0.0, largest = 0.0;
  for (int i = 0; i < 20'000; ++i) {
    integral += error * kStep_s;
    outputs.push_back(gains.p * error + gains.i * integral + gains.d * (error - before) / kStep_s);
    before = error;
    error -= yaw_rate_rad_s * outputs.front() * kStep_s;
    outputs.pop_front();
    if (i >= 19'000) largest = std::max(largest, std::abs(error));
  }
  return largest;
}

TEST_CASE("A proportional loop has the margin of an integrator with a delay") {
  // G p = 2 rad/s crosses over at 2 rad/s; the delay at which 90 degrees are gone is pi / 4.
  const SteeringMargins margins = MarginsOf({0.1, 0.0, 0.0}, 20.0, 0.25);
  CHECK(margins.crossover_rad_s == Approx(2.0));
  CHECK(margins.phase_margin_deg == Approx(90.0 - 0.5 * 180.0 / pi));
  CHECK(margins.longest_delay_s == Approx(pi / 4.0));
}

TEST_CASE("A loop settles just below the longest delay and grows just above it") {
  const control::PidGains gains =
      GENERATE(control::PidGains{0.1, 0.0, 0.0}, control::PidGains{0.1, 0.0, 0.02},
               control::PidGains{0.1, 0.05, 0.0}, control::PidGains{0.08, 0.04, 0.015});
  const double longest_s = MarginsOf(gains, 20.0, 0.1).longest_delay_s;
  REQUIRE(longest_s > 0.05);
  CHECK(ErrorAfter20s(gains, 20.0, 0.9 * longest_s) < 0.5);
  CHECK(ErrorAfter20s(gains, 20.0, 1.1 * longest_s) > 1.0);
}

TEST_CASE("A derivative gain that answers itself is unstable with any delay") {
  const SteeringMargins margins = MarginsOf({0.1, 0.0, 0.06}, 20.0, 0.02);
  CHECK(margins.longest_delay_s == 0.0);
  CHECK(ErrorAfter20s({0.1, 0.0, 0.06}, 20.0, 0.02) > 1.0);
}

TEST_CASE("The steering of a run is identified from its commands and poses") {
  Bench bench;
  bench.robot = {.command_delay_s = 0.12, .sensing_delay_s = 0.10, .frame_period_s = 0.05};
  const TrialResult result = bench.Run();
  REQUIRE(result.outcome == Outcome::kReached);
  const SteeringCheck check = bench.Check(result);
  CHECK(check.is_identified);
  CHECK(check.r2 > 0.9);
  CHECK(check.model.yaw_rate_rad_s == Approx(kYawRate_rad_s).epsilon(0.05));
  CHECK(check.model.speed_mps == Approx(kSpeed_mps).epsilon(0.05));
  CHECK(check.model.command_delay_s == Approx(0.12).margin(0.02));
  CHECK(check.model.pose_age_s == Approx(0.10 + 0.5 * 0.05).margin(0.012));
  CHECK(check.causes.empty());
  CHECK(check.proposals.empty());
  const SteeringPrior wrong{{0.7 * kSpeed_mps, 1.3 * kYawRate_rad_s, 0.0, 0.0}, 0.1};
  const SteeringModel model =
      CheckSteering(result, kTask, bench.navigator, bench.options, wrong).model;
  CHECK(model.yaw_rate_rad_s == Approx(check.model.yaw_rate_rad_s).epsilon(0.01));
  CHECK(model.speed_mps == Approx(check.model.speed_mps).epsilon(0.01));
}

TEST_CASE("A robot drives on the circle that is predicted when its steering is too weak") {
  Bench bench;
  bench.navigator.heading = {0.02, 0.0, 0.0};
  bench.options.timeout_s = 60.0;
  // The distance loop keeps v at v_min on the circle, or drives it up to v_max and so the circle
  // out.
  const bool is_slow = GENERATE(true, false);
  bench.navigator.distance.p = is_slow ? 0.6 : 0.9;
  const TrialResult result = bench.Run();
  REQUIRE(result.outcome == Outcome::kTimedOut);
  const SteeringCheck check = bench.Check(result);
  INFO(Joined(check));
  CHECK(check.circle_m ==
        Approx(0.0415 * (is_slow ? 0.15 : 0.3) / (0.02 * 0.5 * pi)).epsilon(0.02));
  const trajectory::StampedPose& last = result.trajectory.poses.back();
  const Eigen::Vector2d target(last.target_x_m, last.target_y_m);
  CHECK((last.Position() - target).norm() == Approx(check.circle_m).epsilon(0.05));
  CHECK(check.turns > 2.0);
}

void CheckMended(Bench bench, const std::string& cause, const std::string& key) {
  const TrialResult result = bench.Run();
  INFO(result.reason);
  REQUIRE(result.outcome == Outcome::kTimedOut);
  const SteeringCheck check = bench.Check(result);
  INFO(Joined(check));
  CHECK(check.HasCircled());
  REQUIRE_FALSE(check.causes.empty());
  CHECK_THAT(Joined(check), Catch::Contains(cause));
  CHECK_THAT(Joined(check), Catch::Contains("\n" + key + " "));
  bench.Set(check.proposals);
  const TrialResult mended = bench.Run();
  INFO(mended.reason);
  CHECK(mended.outcome == Outcome::kReached);
  CHECK_FALSE(bench.Check(mended).HasCircled());
}

TEST_CASE("A robot that circles since w_max is too low arrives with the limit proposed") {
  Bench bench;
  bench.navigator.w_max = 0.03;
  bench.navigator.heading = {0.15, 0.0, 0.0};
  CheckMended(bench, "control.w_max allows 0.03", "control.w_max");
}

TEST_CASE("A robot that circles since its gain is too low arrives with the gain proposed") {
  Bench bench;
  bench.navigator.heading = {0.02, 0.0, 0.004};
  CheckMended(bench, "control.heading.p 0.02 asks for", "control.heading.p");
}

TEST_CASE(
    "A robot that circles since gain and delay are unstable arrives with the gains proposed") {
  Bench bench;
  bench.robot = {.command_delay_s = 0.25, .sensing_delay_s = 0.15, .frame_period_s = 0.05};
  bench.navigator.heading = {0.6, 0.0, 0.03};
  CheckMended(bench, "the steering is unstable", "control.heading.p");
  const SteeringCheck check = bench.Check(bench.Run());
  bench.Set(check.proposals);
  // By what the robot really is: half a frame is the mean wait for the next pose.
  CHECK(MarginsOf(bench.navigator.heading, kYawRate_rad_s, 0.25 + 0.15 + 0.025).phase_margin_deg >
        55.0);
}

TEST_CASE("A robot that circles since it drives too fast arrives with the speed proposed") {
  Bench bench;
  bench.robot.command_delay_s = 0.2;
  bench.navigator.v_min = bench.navigator.v_max = 0.6;
  CheckMended(bench, "control.v_min keeps v at 0.6", "control.v_min");
}

TEST_CASE("Robots of random gains, delays and limits that circle arrive with what is proposed") {
  std::mt19937 random(7);
  const auto draw = [&](double least, double most) {
    return least * std::pow(most / least, std::uniform_real_distribution<>(0.0, 1.0)(random));
  };
  int circled = 0, explained = 0, mended = 0;
  for (int i = 0; i < 400; ++i) {
    Bench bench;
    bench.robot.command_delay_s = draw(0.01, 0.3);
    bench.robot.sensing_delay_s = draw(0.01, 0.15);
    bench.robot.frame_period_s = draw(0.02, 0.07);
    bench.navigator.heading.p = draw(0.01, 1.0);
    bench.navigator.heading.d = bench.navigator.heading.p * draw(0.01, 0.3);
    bench.navigator.w_min = draw(0.005, 0.02);
    bench.navigator.w_max = draw(0.025, 0.5);
    bench.navigator.v_min = draw(0.1, 0.5);
    bench.navigator.v_max = std::max(0.3, bench.navigator.v_min);
    const TrialResult result = bench.Run();
    const SteeringCheck check = bench.Check(result);
    if (result.outcome == Outcome::kReached || !check.HasCircled()) continue;
    ++circled;
    if (!check.causes.empty()) ++explained;
    bench.Set(check.proposals);
    if (bench.Run().outcome == Outcome::kReached) {
      ++mended;
    } else {
      UNSCOPED_INFO("command " << bench.robot.command_delay_s << " sensing "
                               << bench.robot.sensing_delay_s << "\n"
                               << Joined(check));
    }
  }
  INFO(mended << " of " << circled << " mended, " << explained << " explained");
  CHECK(circled > 50);
  CHECK(explained == circled);
  CHECK(mended >= 19 * circled / 20);
}

TEST_CASE("A robot that was on its way is given the time it needs") {
  Bench bench;
  bench.options.timeout_s = 1.5;
  const TrialResult result = bench.Run();
  REQUIRE(result.outcome == Outcome::kTimedOut);
  CHECK_THAT(result.reason, Catch::Contains("trial.timeout_s, 1.5 s") &&
                                Catch::Contains("control.v_min is 0.15, control.v_max 0.3"));
  const SteeringCheck check = bench.Check(result);
  INFO(Joined(check));
  REQUIRE(check.proposals.size() == 1);
  CHECK(check.proposals[0].key == "trial.timeout_s");
  bench.Set(check.proposals);
  CHECK(bench.Run().outcome == Outcome::kReached);
}

TEST_CASE("A circle too wide for the time of a run is none that was on its way") {
  Bench bench;
  bench.navigator.w_max = bench.navigator.w_min = 0.003;
  const TrialResult result = bench.Run();
  REQUIRE(result.outcome == Outcome::kTimedOut);
  const SteeringCheck check = bench.Check(result);
  CHECK_FALSE(check.HasCircled());
  CHECK_THAT(Joined(check), Catch::Contains("control.w_max allows 0.003"));
  bench.Set(check.proposals);
  CHECK(bench.Run().outcome == Outcome::kReached);
}

TEST_CASE("Motors that are swapped are told from weak steering") {
  class Swapped : public test::FakeRobot {
   public:
    using FakeRobot::FakeRobot;
    void Command(const control::WheelPower& power) override {
      FakeRobot::Command({power.right, power.left});
    }
  };
  Bench bench;
  bench.options.timeout_s = 8.0;
  bench.robot.world_from_start = control::StartPose(kTask);
  Swapped robot(bench.robot);
  const TrialResult result = RunTrial(robot, kTask, bench.navigator, bench.options);
  REQUIRE(result.outcome == Outcome::kTimedOut);
  const SteeringCheck check = bench.Check(result);
  REQUIRE(check.causes.size() == 1);
  CHECK(check.causes[0] ==
        "it turned to the right when it was steered to the left: its motors are swapped, one of "
        "them runs backwards, or the camera's picture is mirrored");
  CHECK(check.proposals.empty());
}

/// Wheels that do not turn below a power, one that turns slower than the other, and a camera whose
/// poses are noisy.
class Worn : public test::FakeRobot {
 public:
  Worn(const test::FakeRobotOptions& options, double dead_band, double right_share)
      : FakeRobot(options), dead_band_(dead_band), right_share_(right_share) {
    std::mt19937 random(3);
    std::normal_distribution<> noise(0.0, 0.001);
    spoil = [random, noise](Sensed& sensed) mutable {
      if (!sensed.pose) return;
      random.seed(static_cast<std::uint32_t>(1e4 * sensed.pose->captured_s) + 1);
      sensed.pose->world_from_robot.x_m += noise(random);
      sensed.pose->world_from_robot.y_m += noise(random);
    };
  }
  void Command(const control::WheelPower& power) override {
    const auto driven = [this](double p) { return std::abs(p) < dead_band_ ? 0.0 : p; };
    FakeRobot::Command({driven(power.left), right_share_ * driven(power.right)});
  }

 private:
  double dead_band_, right_share_;
};

struct WornBench : Bench {
  double dead_band = 0.0, right_share = 1.0;
  SteeringPrior prior = kPrior;

  TrialResult Run() const {
    test::FakeRobotOptions at_start = robot;
    at_start.world_from_start = control::StartPose(kTask);
    Worn worn(at_start, dead_band, right_share);
    return RunTrial(worn, kTask, navigator, options);
  }
  SteeringCheck Check(const TrialResult& result) const {
    return CheckSteering(result, kTask, navigator, options, prior);
  }
};

TEST_CASE("A robot whose powers are too small to move it is given powers that do") {
  WornBench bench;
  // Dead band or friction; from the start, or as soon as it brakes before the waypoint.
  bench.dead_band = GENERATE(0.1, 0.15);
  const bool is_at_once = GENERATE(true, false);
  const bool is_friction = GENERATE(true, false);
  bench.prior.dead_band = is_friction ? 0.02 : bench.dead_band;
  bench.prior.breakaway_power = is_friction ? bench.dead_band : 0.0;
  bench.navigator.v_min = 0.02;
  bench.navigator.v_max = is_at_once ? 0.05 : 0.3;
  bench.navigator.w_max = 0.03;
  const TrialResult result = bench.Run();
  REQUIRE(result.outcome == Outcome::kTimedOut);
  const SteeringCheck check = bench.Check(result);
  INFO(Joined(check));
  REQUIRE(check.causes.size() == 1);
  CHECK_THAT(check.causes[0], Catch::Contains("it does not move: 0.00") &&
                                  Catch::Contains(is_friction ? "breakaway torque over stall torque"
                                                              : "simulation.motor.dead_band"));
  CHECK(ProposedFor(check, "control.v_min") == Approx(1.2 * bench.dead_band));
  bench.Set(check.proposals);
  CHECK(bench.Run().outcome == Outcome::kReached);
}

TEST_CASE("A robot that stands at powers that should move it is told of motors, link and floor") {
  WornBench bench;
  bench.dead_band = 1.0;
  const SteeringCheck check = bench.Check(bench.Run());
  INFO(Joined(check));
  REQUIRE(check.causes.size() == 1);
  CHECK_THAT(check.causes[0], Catch::Contains("it does not move") &&
                                  Catch::Contains("a link that loses the commands") &&
                                  Catch::Contains("a floor that holds it"));
  CHECK(check.proposals.empty());
}

TEST_CASE("A robot that full power does not move is told so and given no power beyond it") {
  WornBench bench;
  bench.dead_band = 1.0;
  bench.prior.breakaway_power = GENERATE(0.9, 1.2);
  const SteeringCheck check = bench.Check(bench.Run());
  INFO(Joined(check));
  REQUIRE(check.causes.size() == 1);
  CHECK_THAT(check.causes[0], Catch::Contains("it does not move") &&
                                  Catch::Contains("full power, 1, is too little"));
  CHECK(check.proposals.empty());
}

TEST_CASE("A power that must move the wheels and steer is proposed up to full power") {
  WornBench bench;
  bench.dead_band = 1.0;
  bench.prior.breakaway_power = 0.8;
  bench.navigator.w_min = bench.navigator.w_max = 0.3;
  bench.navigator.reach_radius_m = 0.4;  // no circle is too wide
  const SteeringCheck check = bench.Check(bench.Run());
  INFO(Joined(check));
  CHECK(ProposedFor(check, "control.v_min") == 1.0);
}

TEST_CASE("No speed is proposed at which the wheels do not turn") {
  WornBench bench;
  bench.prior.dead_band = 0.05;
  bench.prior.breakaway_power = 0.1;
  bench.robot.command_delay_s = 0.2;
  bench.navigator.v_min = bench.navigator.v_max = 0.6;
  bench.navigator.reach_radius_m = 0.005;
  const SteeringCheck check = bench.Check(bench.Run());
  INFO(Joined(check));
  CHECK(ProposedFor(check, "control.v_min") == Approx(0.12));
}

TEST_CASE("The proposal of a slower run contains the time it needs") {
  Bench bench;
  bench.options.timeout_s = 4.0;
  bench.robot.command_delay_s = 0.3;
  bench.navigator.v_min = bench.navigator.v_max = 0.6;
  const TrialResult result = bench.Run();
  REQUIRE(result.outcome == Outcome::kTimedOut);
  const SteeringCheck check = bench.Check(result);
  INFO(Joined(check));
  CHECK(check.proposals.back().key == "trial.timeout_s");
  bench.Set(check.proposals);
  CHECK(bench.Run().outcome == Outcome::kReached);
}

TEST_CASE(
    "Poses that are all stale are told with their age, and the limit that is proposed drives") {
  Bench bench;
  bench.robot.sensing_delay_s = 0.6;
  const TrialResult result = bench.Run();
  REQUIRE(result.outcome == Outcome::kTimedOut);
  const SteeringCheck check = bench.Check(result);
  INFO(Joined(check));
  REQUIRE_FALSE(check.causes.empty());
  CHECK_THAT(check.causes[0], Catch::Contains("decisions were zero power: poses are 0.6") &&
                                  Catch::Contains("trial.pose_stale_s is 0.4 s"));
  CHECK(check.proposals.at(0).key == "trial.pose_stale_s");
  bench.Set(check.proposals);
  CHECK(bench.Run().stale_decisions == 0);
}

TEST_CASE("What is said of refused and stale poses is the same however few rows are logged") {
  Bench bench;
  bench.options.timeout_s = 6.0;
  const bool is_stale = GENERATE(true, false);
  test::FakeRobotOptions at_start{.world_from_start = control::StartPose(kTask)};
  if (is_stale) at_start.sensing_delay_s = 0.6;
  const auto run = [&] {
    test::FakeRobot robot(at_start);
    robot.spoil = [&](Sensed& sensed) {
      const bool jumps = !is_stale && std::llround(50.0 * sensed.now_s) % 3 != 0;
      if (jumps) sensed.pose->world_from_robot.x_m += 5.0;
    };
    return RunTrial(robot, kTask, bench.navigator, bench.options);
  };
  TrialResult whole = run();
  bench.options.log_period_s = 0.5;
  TrialResult thinned = run();
  whole.outcome = thinned.outcome = Outcome::kTimedOut;  // of jumps enough are left to arrive
  REQUIRE(thinned.trajectory.poses.size() > 1);
  REQUIRE(5 * thinned.trajectory.poses.size() < whole.trajectory.poses.size());
  CHECK(thinned.poses_believed == whole.poses_believed);
  const SteeringCheck of_whole = bench.Check(whole), of_thinned = bench.Check(thinned);
  REQUIRE_FALSE(of_whole.causes.empty());
  CHECK(of_thinned.causes.front() == of_whole.causes.front());
  if (!is_stale) return;
  // The log ends with its last row.
  const double limit_s = ProposedFor(of_whole, "trial.pose_stale_s");
  CHECK(limit_s > 0.6);
  CHECK(ProposedFor(of_thinned, "trial.pose_stale_s") == Approx(limit_s).epsilon(0.03));
}

TEST_CASE("Of a gate that is too narrow its key is proposed and no gain") {
  Bench bench;
  const bool is_speed = GENERATE(true, false);
  if (is_speed) bench.navigator.pose_gate.max_speed_mps = 0.1;
  if (!is_speed) bench.navigator.pose_gate.max_yaw_rate_rad_s = 0.02;
  bench.options.timeout_s = 6.0;
  const TrialResult result = bench.Run();
  REQUIRE(result.outcome != Outcome::kReached);
  const SteeringCheck check = bench.Check(result);
  INFO(Joined(check));
  REQUIRE(check.causes.size() == 1);
  CHECK_THAT(check.causes[0], Catch::Contains("refused as jumps beyond"));
  REQUIRE(check.proposals.size() == 1);
  CHECK(check.proposals[0].key ==
        (is_speed ? "control.pose_gate.max_speed_mps" : "control.pose_gate.max_yaw_rate_rad_s"));
  bench.Set(check.proposals);
  CHECK(bench.Run().outcome == Outcome::kReached);
}

TEST_CASE("Poses that jump farther than the robot drives are told from a gate that is too narrow") {
  Bench bench;
  test::FakeRobotOptions at_start = bench.robot;
  at_start.world_from_start = control::StartPose(kTask);
  test::FakeRobot robot(at_start);
  robot.spoil = [](Sensed& sensed) {
    if (std::llround(50.0 * sensed.now_s) % 3 != 0) sensed.pose->world_from_robot.x_m += 5.0;
  };
  const TrialResult result = RunTrial(robot, kTask, bench.navigator, bench.options);
  REQUIRE(result.poses_refused > 0);
  if (result.outcome == Outcome::kReached) bench.options.timeout_s = 1.0;
  TrialResult late = result;
  late.outcome = Outcome::kTimedOut;
  const SteeringCheck check = bench.Check(late);
  REQUIRE(check.causes.size() == 1);
  CHECK_THAT(check.causes[0], Catch::Contains("the camera's poses jump"));
  CHECK(check.proposals.empty());
}

TEST_CASE("A pull to one side is named, with its side, and the proposal arrives in spite of it") {
  WornBench bench;
  bench.robot = {.command_delay_s = 0.1, .sensing_delay_s = 0.07, .frame_period_s = 0.05};
  bench.right_share = 0.6;
  const TrialResult result = bench.Run();
  REQUIRE(result.outcome == Outcome::kTimedOut);
  const SteeringCheck check = bench.Check(result);
  INFO(Joined(check));
  REQUIRE_FALSE(check.causes.empty());
  CHECK_THAT(check.causes[0], Catch::Contains("it pulls to the right"));
  // Half of what the wheels differ by, over the track.
  CHECK(check.model.pull_rad_s == Approx(-0.4 * kSpeed_mps / 0.083).epsilon(0.25));
  bench.Set(check.proposals);
  CHECK(bench.Run().outcome == Outcome::kReached);
}

TEST_CASE("Of a pull that is not held the gains that ask for too little are named") {
  WornBench bench;
  bench.robot = {.command_delay_s = 0.1, .sensing_delay_s = 0.07, .frame_period_s = 0.05};
  bench.right_share = 0.6;
  bench.options.timeout_s = 10.0;
  const TrialResult result = bench.Run();
  REQUIRE(result.outcome == Outcome::kTimedOut);
  // The same run, held against other gains.
  const auto why = [&](const control::PidGains& heading) {
    bench.navigator.heading = heading;
    return Joined(bench.Check(result));
  };
  const std::string none = why({0.0, 0.0, 0.0});
  CHECK_THAT(none, Catch::Contains("control.heading.p 0 asks for 0 at any heading error"));
  CHECK_THAT(none, !Catch::Contains("control.w_max allows"));
  CHECK_THAT(why({0.0, 0.01, 0.0}),
             Catch::Contains("control.heading.p 0 and control.heading.i 0.01 ask for 0.02 at any"));
  CHECK_THAT(
      why({0.02, 0.01, 0.0}),
      Catch::Contains("control.heading.p 0.02 and control.heading.i 0.01 ask for that only"));
  // Its integral holds more than the wheels differ by: 2 x 0.1.
  CHECK_THAT(why({0.02, 0.1, 0.0}), !Catch::Contains("it pulls"));
}

TEST_CASE("A steering that w_min raises is told so") {
  Bench bench;
  bench.navigator.heading = {0.005, 0.0, 0.0};
  bench.options.timeout_s = 60.0;
  const SteeringCheck check = bench.Check(bench.Run());
  CHECK_THAT(Joined(check), Catch::Contains("control.w_min raises that to 0.02"));
}

TEST_CASE("A run that ended on its way is told how it ended, and how large its circle is") {
  Bench bench;
  bench.navigator.heading = {0.1, 0.0, 0.0};
  TrialResult result = bench.Run();
  REQUIRE(result.outcome == Outcome::kReached);
  result.trajectory.poses.resize(result.trajectory.poses.size() / 2);
  const auto cause = [&](Outcome outcome) {
    result.outcome = outcome;
    const SteeringCheck check = bench.Check(result);
    INFO(Joined(check));
    CHECK(check.proposals.empty());
    REQUIRE(check.causes.size() == 1);
    CHECK_THAT(check.causes[0], Catch::Contains(fmt::format("{:.3f} m, ", check.circle_m)));
    const bool is_within = check.circle_m <= bench.navigator.reach_radius_m;
    CHECK_THAT(check.causes[0],
               Catch::EndsWith(is_within ? "lies within control.reach_radius_m"
                                         : "is larger than control.reach_radius_m"));
    return check.causes[0];
  };
  for (const double reach_m : {bench.navigator.reach_radius_m, 0.2}) {
    bench.navigator.reach_radius_m = reach_m;
    CHECK_THAT(cause(Outcome::kLeftArena), Catch::StartsWith("it left the arena (trial.arena), "));
    CHECK_THAT(cause(Outcome::kLost), Catch::StartsWith("it was lost from sight, "));
  }
}

TEST_CASE("A run that circled and arrived with no limit to blame has no cause") {
  Bench bench;
  bench.navigator.heading = {0.1, 0.0, 0.0};
  TrialResult result = bench.Run();
  REQUIRE(result.outcome == Outcome::kReached);
  // Somebody turned it round by hand before it drove.
  std::vector<trajectory::StampedPose>& poses = result.trajectory.poses;
  std::vector<trajectory::StampedPose> before;
  for (int i = 80; i > 0; --i) {
    before.push_back(poses.front());
    before.back().t_s -= 0.1 * i;
    before.back().yaw_rad = geometry::WrapToPi(before.back().yaw_rad - 0.1 * i);
  }
  poses.insert(poses.begin(), before.begin(), before.end());
  const SteeringCheck check = bench.Check(result);
  INFO(Joined(check));
  CHECK(check.HasCircled());
  CHECK(check.causes.empty());
  CHECK(check.proposals.empty());
}

TEST_CASE("Proposals are tried, joined with what the next run proposes, and kept if one arrives") {
  SteeringCheck check;
  check.proposals = {{"a", 1.0, 2.0}};
  std::vector<std::vector<KeyProposal>> tried;
  const bool ends_well = GENERATE(true, false);
  TryProposals(check, [&](const std::vector<KeyProposal>& proposals) {
    tried.push_back(proposals);
    TriedRun run;
    run.result.end_s = 7.0;
    run.result.outcome = ends_well && tried.size() == 3 ? Outcome::kReached : Outcome::kTimedOut;
    if (tried.size() == 1) run.check.proposals = {{"b", 5.0, 6.0}};
    if (tried.size() == 2) run.check.proposals = {{"a", 2.0, 3.0}};
    return run;
  });
  REQUIRE(tried.size() == 3);
  CHECK(tried[1].size() == 2);
  CHECK(check.failed_tries == (ends_well ? 2 : 3));
  if (!ends_well) {
    CHECK(check.proposals.empty());
    CHECK_FALSE(check.tried_s);
    return;
  }
  REQUIRE(check.proposals.size() == 2);
  CHECK(check.proposals[0].was == 1.0);
  CHECK(check.proposals[0].value == 3.0);
  CHECK(check.proposals[1].key == "b");
  CHECK(check.tried_s == Approx(7.0));
}

/// All that a check found, as text.
std::string Everything(const std::string& name, const SteeringCheck& check) {
  const SteeringModel& model = check.model;
  std::string text = fmt::format(
      "{}\n{:.3f} turns, identified {}, pull told {}, r2 {:.6f}, arrived {}\nspeed {:.6f}, yaw "
      "rate "
      "{:.6f}, age {:.6f}, delay {:.6f}, pull {:.6f}, of the loop {:.6f}\ncrossover {:.6f}, margin "
      "{:.6f}, longest {:.6f}, circle {:.6f}, swing {:.6f} {:.6f}\n",
      name, check.turns, check.is_identified, check.is_pull_told, check.r2, check.has_arrived,
      model.speed_mps, model.yaw_rate_rad_s, model.pose_age_s, model.command_delay_s,
      model.pull_rad_s, check.delay_s, check.margins.crossover_rad_s,
      check.margins.phase_margin_deg, check.margins.longest_delay_s, check.circle_m,
      check.swing.heading_rad, check.swing.path_m);
  for (const std::string& cause : check.causes) text += cause + "\n";
  for (const KeyProposal& proposal : check.proposals) {
    text += fmt::format("{}: {} instead of {}\n", proposal.key, proposal.value, proposal.was);
  }
  return text + "\n";
}

TEST_CASE("What is found and proposed for runs of every kind is the pinned text") {
  std::string text;
  const auto add = [&](const std::string& name, const WornBench& bench) {
    text += Everything(name, bench.Check(bench.Run()));
  };
  WornBench late;
  late.robot = {.command_delay_s = 0.12, .sensing_delay_s = 0.10, .frame_period_s = 0.05};
  add("a good run", late);
  WornBench weak = late;
  weak.navigator.heading = {0.02, 0.0, 0.004};
  add("weak gains", weak);
  WornBench limited = late;
  limited.navigator.w_max = 0.03;
  add("a low w_max", limited);
  WornBench unstable = late;
  unstable.robot.command_delay_s = 0.25;
  unstable.navigator.heading = {0.3, 0.02, 0.01};
  add("too much gain", unstable);
  WornBench fast = late;
  fast.navigator.v_min = fast.navigator.v_max = 0.6;
  fast.navigator.reach_radius_m = 0.02;
  fast.options.timeout_s = 4.0;
  add("too fast", fast);
  WornBench coarse = late;
  coarse.navigator.w_min = 0.2;
  add("a coarse w_min", coarse);
  for (const double share : {0.6, 1.5}) {
    WornBench pulling = late;
    pulling.right_share = share;
    add(fmt::format("the right wheel at {} of its speed", share), pulling);
  }
  WornBench still;
  still.dead_band = 0.15;
  still.prior.dead_band = 0.02;
  still.prior.breakaway_power = 0.15;
  still.navigator.v_min = 0.02;
  still.navigator.v_max = 0.05;
  still.navigator.cruise_speed = 0.03;
  add("too weak to move", still);
  WornBench broken;
  broken.dead_band = 1.0;
  add("no motors", broken);
  WornBench stale;
  stale.robot.sensing_delay_s = 0.6;
  add("old poses", stale);
  WornBench gate = late;
  gate.navigator.pose_gate.max_speed_mps = 0.1;
  add("a gate of speed", gate);
  gate.navigator.pose_gate.max_speed_mps = 5.0;
  gate.navigator.pose_gate.max_yaw_rate_rad_s = 0.3;
  add("a gate of turns", gate);
  WornBench soon = late;
  soon.options.timeout_s = 1.5;
  add("too little time", soon);
  CHECK(test::DifferenceFromPinned("trial/steering.txt", text) == "");
}

}  // namespace
}  // namespace rift::trial
