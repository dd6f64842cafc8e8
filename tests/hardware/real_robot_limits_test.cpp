// Times that the robot's side of a drive counts by, on both sides of each.

#include <catch2/catch.hpp>

#include "bench.hpp"
#include "rift/hardware/real_robot.hpp"

namespace rift::hardware {
namespace {

using control::WheelPower;

void DriveOn(RealRobot& robot, const WheelPower& power, double duration_s, Bench& bench) {
  for (const double end_s = bench.Now_s() + duration_s; bench.Now_s() < end_s;) {
    robot.Sense();
    robot.Command(power);
    robot.Advance(0.02);
  }
}

void Settle(RealRobot& robot, Bench& bench) {
  for (const double end_s = bench.Now_s() + 0.4; bench.Now_s() < end_s;) {
    robot.Sense();
    robot.Advance(0.02);
  }
}

void AdvanceTo(RealRobot& robot, double end_s, Bench& bench) {
  robot.Advance(end_s - bench.Now_s());
}

TEST_CASE("After a pause of the pictures the next one is expected within a tenth of a second") {
  Bench bench;
  HardwareOptions hardware;
  hardware.line.heartbeat_s = 0.2;
  hardware.guard.link_lag_s = hardware.guard.pose_stale_s = hardware.guard.control_stale_s = 1.0;
  hardware.evidence = {.blind_m = 10.0,
                       .repeats_s = 3600.0,
                       .pushed_m = 10.0,
                       .pushed_deg = 180.0,
                       .agree_m = 10.0,
                       .max_latency_s = 2.0};
  RealRobot robot(bench, bench, bench, {hardware, Protocol::kFramed, false});
  Settle(robot, bench);
  robot.Arm();
  DriveOn(robot, {0.2, 0.2}, 0.2, bench);
  bench.camera_is_frozen = true;
  DriveOn(robot, {0.2, 0.2}, 0.4, bench);
  bench.camera_is_frozen = false;
  const size_t before = robot.Record().poses.size();
  while (robot.Record().poses.size() == before) {
    robot.Advance(0.04);
    robot.Sense();
  }
  bench.camera_is_frozen = true;
  const double sensed_s = bench.Now_s();
  robot.Command({0.21, 0.2});
  AdvanceTo(robot, sensed_s + 0.06, bench);
  CHECK(bench.written.count({210, 200}) == 1);
  // A frame and its answer keep the line for 15 bytes of the 480 a second: 0.031 s.
  robot.Command({0.22, 0.2});
  AdvanceTo(robot, sensed_s + 0.072, bench);
  CHECK(bench.written.count({220, 200}) == 1);
  robot.Command({0.23, 0.2});  // would hold up the first command for the next picture
  AdvanceTo(robot, sensed_s + 0.2, bench);
  CHECK(bench.written.count({230, 200}) == 0);
  AdvanceTo(robot, sensed_s + 0.3, bench);
  CHECK(bench.written.count({230, 200}) == 1);
  INFO((robot.Record().stop ? robot.Record().stop->text : std::string("drives")));
  CHECK(robot.state() == DriveState::kArmed);
}

TEST_CASE("Plain answers may stay away for half a second before the wheels are those commanded") {
  for (const double away_s : {0.2, 0.75}) {
    Bench bench;
    HardwareOptions hardware;
    hardware.line.heartbeat_s = 0.02;
    RealRobot robot(bench, bench, bench, {hardware, Protocol::kPlain, false});
    Settle(robot, bench);
    robot.Arm();
    DriveOn(robot, {0.2, 0.2}, 0.5, bench);
    bench.from_robot_is_cut = true;
    DriveOn(robot, {0.2, 0.2}, away_s, bench);
    bench.from_robot_is_cut = false;
    DriveOn(robot, {0.2, 0.2}, 0.5, bench);
    REQUIRE(robot.state() == DriveState::kArmed);
    bench.bend = [frozen = bench.Pose()](trial::PoseMeasurement& pose) {
      pose.world_from_robot = frozen;
    };
    DriveOn(robot, {0.2, 0.2}, 3.0, bench);
    REQUIRE(robot.Record().stop);
    INFO(away_s << ": " << robot.Record().stop->text);
    const bool by_counts = robot.Record().stop->reason == StopReason::kPoseDisagrees;
    CHECK(by_counts == (away_s < 0.5));
  }
}

TEST_CASE("A robot that cannot be armed says why, and a power before that ends the drive") {
  Bench bench;
  bench.tag_is_hidden = true;
  RealRobot unseen(bench, bench, bench, {{}, Protocol::kFramed, false});
  Settle(unseen, bench);
  CHECK_THROWS_WITH(unseen.Arm(), "cannot arm: the robot has not been seen yet");
  bench.tag_is_hidden = false;
  Settle(unseen, bench);
  unseen.Command({0.0, 0.25});
  REQUIRE(unseen.Record().stop);
  CHECK(unseen.Record().stop->text == "a power was commanded before the drive was armed");
  CHECK(bench.obeyed == std::set<std::pair<int, int>>{{0, 0}});
}

TEST_CASE("The voltage of a battery is told with two digits beside its limit") {
  Bench bench;
  bench.battery_mv = 4810;
  HardwareOptions hardware;
  hardware.guard.battery_min_v = 4.2;
  RealRobot robot(bench, bench, bench, {hardware, Protocol::kFramed, false});
  Settle(robot, bench);
  robot.Arm();
  DriveOn(robot, {0.2, 0.2}, 0.4, bench);
  REQUIRE(robot.state() == DriveState::kArmed);
  bench.battery_mv = 4137;
  DriveOn(robot, {0.2, 0.2}, 0.4, bench);
  REQUIRE(robot.Record().stop);
  CHECK(robot.Record().stop->text == "the battery is at 4.14 V, below 4.20 V");
}

}  // namespace
}  // namespace rift::hardware
