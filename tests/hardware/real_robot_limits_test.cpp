// Times that the robot's side of a drive counts by, on both sides of each.

#include <catch2/catch.hpp>
#include <ctime>

#include "bench.hpp"
#include "hardware/suspend_watch.hpp"
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

TEST_CASE("A robot that is let go is sent zeros for 0.3 s, or until it has confirmed its stop") {
  for (const bool is_confirmed : {false, true}) {
    Bench bench;
    double begun_s = 0.0;
    size_t zeros_before = 0;
    {
      RealRobot robot(bench, bench, bench, {{}, Protocol::kFramed, false});
      Settle(robot, bench);
      robot.Arm();
      DriveOn(robot, {0.2, 0.2}, 0.3, bench);
      if (is_confirmed) {
        robot.Stop();
        robot.ConfirmStop(5.0);
        REQUIRE(robot.Record().stop_acknowledged == true);
      }
      bench.from_robot_is_cut = true;
      begun_s = bench.Now_s();
      zeros_before = bench.zeros_heard;
    }
    CHECK(bench.Now_s() - begun_s == Approx(is_confirmed ? 0.0 : 0.3).margin(0.0015));
    if (!is_confirmed) CHECK(bench.zeros_heard >= zeros_before + 3);
    CHECK(bench.listener->Motors().IsZero());
  }
}

TEST_CASE("A stop is on a free line before anything else is done") {
  Bench bench;
  HardwareOptions hardware;
  hardware.line.baud = 1'000'000;  // no command waits for the one before
  RealRobot robot(bench, bench, bench, {hardware, Protocol::kFramed, false});
  Settle(robot, bench);
  robot.Arm();
  DriveOn(robot, {0.2, 0.25}, 0.3, bench);
  bench.written.clear();
  const size_t sent = robot.Record().sent;
  robot.Stop();
  CHECK(bench.written == std::set<std::pair<int, int>>{{0, 0}});
  CHECK(robot.Record().sent == sent + 1);
}

TEST_CASE("A stop is acknowledged by no answer to a zero that was sent before it") {
  for (int i = 0; i < 10; ++i) {
    Bench bench;
    bench.counts_are_stuck = true;  // nothing is to be waited for but the answer
    HardwareOptions hardware;
    hardware.evidence.pushed_m = hardware.evidence.agree_m = 10.0;
    RealRobot robot(bench, bench, bench, {hardware, Protocol::kFramed, false});
    Settle(robot, bench);
    robot.Arm();
    DriveOn(robot, {0.2, 0.2}, 0.3, bench);
    DriveOn(robot, {}, 0.3, bench);
    bench.Wait(0.005 * i);
    const double stopped_s = bench.Now_s();
    robot.Stop();
    robot.ConfirmStop(1.0);
    CHECK(robot.Record().stop_acknowledged == true);
    // Twice the radio and the bytes of one command and its answer.
    CHECK(bench.Now_s() - stopped_s > 2 * 0.02 + (11 + 15) * 10.0 / 9600.0 - 0.002);
  }
}

/// Its camera may lose all it knew.
class Forgetful : public Bench {
 public:
  bool has_forgotten = false;
  PoseNews Newest() override { return has_forgotten ? PoseNews{} : Bench::Newest(); }
};

TEST_CASE("Where a robot was last seen is known once it is stopped, and not before its start") {
  for (const bool is_stopped : {true, false}) {
    Forgetful bench;
    RealRobot robot(bench, bench, bench, {{}, Protocol::kFramed, false});
    Settle(robot, bench);
    REQUIRE(robot.Sense().pose);
    if (is_stopped) robot.Stop();
    bench.has_forgotten = true;
    Settle(robot, bench);
    CHECK(robot.Sense().pose.has_value() == is_stopped);
  }
}

TEST_CASE("A machine may be suspended for as long as its limit each time, and no longer") {
  double suspended_s = 1000.0;
  const Stopper stopper = SuspendStopper(0.25, [&suspended_s] { return suspended_s; });
  CHECK_FALSE(stopper());
  for (int i = 0; i < 4; ++i) {
    suspended_s += 0.25;
    CHECK_FALSE(stopper());
  }
  suspended_s += 12.375;
  const auto stop = stopper();
  REQUIRE(stop);
  CHECK(stop->first == StopReason::kHostStalled);
  CHECK(stop->second == "the machine was suspended for 12.4 s");
  CHECK_FALSE(stopper());  // it has been told
  // Since it was started, by the clock that goes on meanwhile.
  const auto now_s = [](clockid_t clock) {
    timespec now{};
    ::clock_gettime(clock, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
  };
  const double all_s = now_s(CLOCK_BOOTTIME), awake_s = now_s(CLOCK_MONOTONIC);
  CHECK(Suspended_s() == Approx(all_s - awake_s).margin(0.05));
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
