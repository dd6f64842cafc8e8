// What the robot's side of a drive senses and records, beside a bench whose wheels are known.

#include "rift/hardware/real_robot.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "bench.hpp"
#include "hardware/suspend_watch.hpp"
#include "support/mirror.hpp"

namespace rift::hardware {
namespace {

using control::WheelPower;
using test::OnBothSides;
using test::Side;

constexpr double kPeriod_s = 0.02;

void DriveOn(RealRobot& robot, const WheelPower& power, double duration_s, Bench& bench) {
  for (const double end_s = bench.Now_s() + duration_s; bench.Now_s() < end_s;) {
    robot.Sense();
    robot.Command(power);
    robot.Advance(kPeriod_s);
  }
}

/// From now on every picture repeats the pose of now to within its noise, which no corners give
/// away.
void FreezePoses(Bench& bench) {
  bench.bend = [frozen = bench.Pose()](trial::PoseMeasurement& pose) {
    pose.world_from_robot = frozen;
  };
}

/// Drives on with poses that stand; what stops it.
DriveStop StopOfFrozenPoses(RealRobot& robot, double duration_s, Bench& bench) {
  FreezePoses(bench);
  DriveOn(robot, {0.2, 0.2}, duration_s, bench);
  REQUIRE(robot.Record().stop);
  return *robot.Record().stop;
}

/// So long that the robot is seen and has answered.
void Settle(RealRobot& robot, double duration_s, Bench& bench) {
  for (const double end_s = bench.Now_s() + duration_s; bench.Now_s() < end_s;) {
    robot.Sense();
    robot.Advance(kPeriod_s);
  }
}

/// A reading is of the middle of its round trip: half of it before, the first command for a pose
/// was written, and half of it after, the answer was heard. How many poses are settled.
size_t CheckSettled(const DriveRecord& record) {
  size_t settled = 0;
  for (const PoseStages& pose : record.poses) {
    if (pose.written_s < 0.0 || pose.answered_s < 0.0) continue;
    ++settled;
    bool is_there = false;
    for (size_t i = 0; i < record.encoders.size(); ++i) {
      const double half_s = 0.5 * record.round_trips_s[i], at_s = record.encoders[i].t_s;
      is_there = is_there || (std::abs(at_s - half_s - pose.written_s) < 1e-9 &&
                              std::abs(at_s + half_s - pose.answered_s) < 1e-9);
    }
    CHECK(is_there);
  }
  return settled;
}

TEST_CASE("Each wheel's counts, battery and time are those of the robot when it answered") {
  OnBothSides("left", "right", [](const Side& side) {
    for (const double sign : {1.0, -1.0}) {
      Bench bench;
      bench.battery_mv = 4321;
      RealRobot robot(bench, bench, bench, {{}, Protocol::kFramed, false});
      Settle(robot, 0.4, bench);
      CHECK(robot.Sense().encoders == control::EncoderCounts{0, 0});
      robot.Arm();
      DriveOn(robot, side.Of<WheelPower>(sign * 0.2, sign * 0.1), 0.6, bench);
      const trial::Sensed sensed = robot.Sense();
      REQUIRE(sensed.encoders);
      const auto fast =
          static_cast<double>(side.IsFirst() ? sensed.encoders->left : sensed.encoders->right);
      const auto slow =
          static_cast<double>(side.IsFirst() ? sensed.encoders->right : sensed.encoders->left);
      CHECK(fast / slow == Approx(2.0).margin(0.02));
      CHECK(sign * slow > 100.0);
      CHECK(sensed.now_s == Approx(bench.Now_s() - 100.0));

      const DriveRecord record = robot.Record();
      CHECK(record.encoders.back().counts == *sensed.encoders);
      CHECK(record.encoders.back().battery_v == Approx(4.321));
      REQUIRE(record.round_trips_s.size() == record.encoders.size());
      CHECK(CheckSettled(record) > 10);
    }
  });
}

TEST_CASE(
    "A battery below its limit ends a drive, in frames and in plain lines that are answered") {
  for (const Protocol protocol : {Protocol::kFramed, Protocol::kPlain}) {
    CAPTURE(protocol);
    Bench bench;
    bench.battery_mv = 3600;
    HardwareOptions hardware;
    hardware.guard.battery_min_v = 3.6;
    RealRobot robot(bench, bench, bench, {hardware, protocol, false});
    Settle(robot, 0.4, bench);
    robot.Arm();
    DriveOn(robot, {0.2, 0.2}, 0.5, bench);
    REQUIRE(robot.state() == DriveState::kArmed);
    bench.battery_mv = 3599;
    DriveOn(robot, {0.2, 0.2}, 0.5, bench);
    const std::optional<DriveStop> stop = robot.Record().stop;
    REQUIRE(stop);
    CHECK(stop->reason == StopReason::kBatteryLow);
    CHECK(bench.listener->Motors().IsZero());
  }
}

TEST_CASE("Wheels of a robot that does not answer are taken to obey, either one and either way") {
  OnBothSides("left", "right", [](const Side& side) {
    for (const double sign : {1.0, -1.0}) {
      Bench bench;
      bench.from_robot_is_cut = true;
      bench.bend = [](trial::PoseMeasurement& pose) { pose.world_from_robot = {0.1, 0.2, 0.3}; };
      RealRobot robot(bench, bench, bench, {{}, Protocol::kPlain, false});
      Settle(robot, 0.4, bench);
      robot.Arm();
      const double armed_s = bench.Now_s();
      DriveOn(robot, side.Of<WheelPower>(sign * 0.3, 0.0), 2.0, bench);
      const std::optional<DriveStop> stop = robot.Record().stop;
      REQUIRE(stop);
      CHECK(stop->reason == StopReason::kPoseStands);
      // 0.48 m/s, 0.1 s after the command; 3 x (0.012 m + 0.35 s x 0.48 m/s) take 1.125 s.
      CHECK(stop->at_s - (armed_s - 100.0) == Approx(1.26).margin(0.06));
      CHECK(bench.listener->Motors().IsZero());
    }
  });
}

TEST_CASE("A robot whose answers end is watched by its commands and driven on no frozen picture") {
  for (const bool answers_on : {true, false}) {
    Bench bench;
    RealRobot robot(bench, bench, bench, {{}, Protocol::kPlain, false});
    Settle(robot, 0.4, bench);
    REQUIRE(robot.Sense().encoders);
    robot.Arm();
    DriveOn(robot, {0.2, 0.2}, 1.0, bench);
    REQUIRE(robot.state() == DriveState::kArmed);
    bench.from_robot_is_cut = !answers_on;
    DriveOn(robot, {0.2, 0.2}, 1.5, bench);
    INFO((robot.Record().stop ? robot.Record().stop->text : std::string("drives")));
    CHECK(robot.state() == DriveState::kArmed);  // pictures go on to show that it moves
    const double frozen_s = bench.Now_s() - 100.0;
    const DriveStop stop = StopOfFrozenPoses(robot, 3.0, bench);
    const bool by_counts = stop.reason == StopReason::kPoseDisagrees;
    CHECK(by_counts == answers_on);
    // 0.32 m/s: 3 x (0.012 m + 0.35 s x 0.32 m/s) take 1.16 s.
    CHECK(stop.at_s - frozen_s < 1.3);
    CHECK(bench.listener->Motors().IsZero());
  }
}

TEST_CASE(
    "A robot whose answers had ended before it was armed is watched by them once they are back") {
  Bench bench;
  RealRobot robot(bench, bench, bench, {{}, Protocol::kPlain, false});
  Settle(robot, 0.4, bench);
  bench.from_robot_is_cut = true;
  Settle(robot, 1.0, bench);
  bench.from_robot_is_cut = false;
  Settle(robot, 0.4, bench);
  robot.Arm();
  DriveOn(robot, {0.2, 0.2}, 1.0, bench);
  REQUIRE(robot.state() == DriveState::kArmed);
  CHECK(StopOfFrozenPoses(robot, 3.0, bench).reason == StopReason::kPoseDisagrees);
}

TEST_CASE("What carried the robot to its start, before it was armed, is not held against it") {
  Bench bench;
  RealRobot robot(bench, bench, bench, {{}, Protocol::kFramed, false});
  Settle(robot, 1.0, bench);
  bench.bend = [](trial::PoseMeasurement& pose) { pose.world_from_robot.x_m += 0.5; };
  Settle(robot, 0.3, bench);
  robot.Arm();
  DriveOn(robot, {0.2, 0.2}, 0.5, bench);
  INFO((robot.Record().stop ? robot.Record().stop->text : std::string("drives")));
  CHECK(robot.state() == DriveState::kArmed);
}

TEST_CASE("Answers may stay away for as long as the guard waits for them before they have ended") {
  for (const double away_s : {0.7, 1.3}) {
    Bench bench;
    HardwareOptions hardware;
    hardware.guard.link_lag_s = 1.0;
    RealRobot robot(bench, bench, bench, {hardware, Protocol::kPlain, false});
    Settle(robot, 0.4, bench);
    robot.Arm();
    DriveOn(robot, {0.2, 0.2}, 0.5, bench);
    bench.from_robot_is_cut = true;
    DriveOn(robot, {0.2, 0.2}, away_s, bench);
    bench.from_robot_is_cut = false;
    DriveOn(robot, {0.2, 0.2}, 0.4, bench);
    REQUIRE(robot.state() == DriveState::kArmed);
    const DriveStop stop = StopOfFrozenPoses(robot, 3.0, bench);
    INFO(away_s << ": " << stop.text);
    const bool by_counts = stop.reason == StopReason::kPoseDisagrees;
    CHECK(by_counts == (away_s < 1.0));
  }
}

TEST_CASE("Answers that come now and then do not take a robot from the watch of its commands") {
  Bench bench;
  RealRobot robot(bench, bench, bench, {{}, Protocol::kPlain, false});
  Settle(robot, 0.4, bench);
  robot.Arm();
  FreezePoses(bench);
  bench.counts_are_stuck = true;
  for (int i = 0; i < 6; ++i) {
    bench.from_robot_is_cut = true;
    DriveOn(robot, {0.2, 0.2}, 0.6, bench);
    bench.from_robot_is_cut = false;
    DriveOn(robot, {0.2, 0.2}, 0.22, bench);
  }
  REQUIRE(robot.Record().stop);
  CHECK(robot.Record().stop->reason == StopReason::kPoseStands);
}

TEST_CASE("On one and the same picture no robot is driven, whatever its wheels tell") {
  struct Line {
    Protocol protocol;
    bool is_cut;
  };
  for (const Line line :
       {Line{Protocol::kFramed, false}, {Protocol::kPlain, false}, {Protocol::kPlain, true}}) {
    Bench bench;
    bench.counts_are_stuck = true;
    HardwareOptions hardware;
    hardware.evidence.pushed_m = 10.0;  // wheels that tell nothing would stop the drive before
    hardware.evidence.pushed_deg = 180.0;
    hardware.evidence.agree_m = 10.0;
    RealRobot robot(bench, bench, bench, {hardware, line.protocol, false});
    Settle(robot, 0.4, bench);
    // A robot that stands at zero power may be shown so for long, and also while it sets off.
    bench.repeats_since_s = bench.Now_s();
    Settle(robot, 2.0, bench);
    robot.Arm();
    bench.from_robot_is_cut = line.is_cut;
    DriveOn(robot, {0.2, 0.2}, 0.5, bench);
    CHECK(robot.state() == DriveState::kArmed);
    bench.repeats_since_s.reset();
    DriveOn(robot, {0.2, 0.2}, 1.0, bench);
    DriveOn(robot, {}, 0.3, bench);
    bench.repeats_since_s = bench.Now_s();
    DriveOn(robot, {}, 2.0, bench);
    CHECK(robot.state() == DriveState::kArmed);
    const double driven_s = bench.Now_s() - 100.0;
    DriveOn(robot, {0.2, 0.2}, 1.0, bench);
    REQUIRE(robot.Record().stop);
    CHECK(robot.Record().stop->reason == StopReason::kPictureRepeats);
    // Of wheels that tell: the sum of repeats_s, max_latency_s and link_lag_s, and a picture more.
    const double after_s = robot.Record().stop->at_s - driven_s;
    CHECK(after_s < 0.68);
    if (!line.is_cut) CHECK(after_s > 0.6);
    CHECK(bench.listener->Motors().IsZero());
  }
}

/// Gives each line of a plain robot twice, as one that comes late and with the next does.
class Twice : public Bench {
 public:
  std::vector<std::uint8_t> Read() override {
    std::vector<std::uint8_t> whole;
    for (const std::uint8_t byte : Bench::Read()) {
      line_.push_back(byte);
      if (byte != '\n') continue;
      for (int i = 0; i < 2; ++i) whole.insert(whole.end(), line_.begin(), line_.end());
      line_.clear();
    }
    return whole;
  }

 private:
  std::vector<std::uint8_t> line_;
};

TEST_CASE("Plain answers that come at once are one reading, and what is saved can be read") {
  size_t readings = 0;
  const auto drive = [&readings](Bench& bench) {
    RealRobot robot(bench, bench, bench, {{}, Protocol::kPlain, false});
    Settle(robot, 0.4, bench);
    robot.Arm();
    DriveOn(robot, {0.2, 0.2}, 1.0, bench);
    readings = robot.Record().encoders.size();
    CHECK(readings > 3);
    CHECK(odometry::ReadEncoders(odometry::EncodersCsv(robot.Record().encoders), "e").size() ==
          readings);
  };
  Bench once;
  drive(once);
  const size_t alone = readings;
  Twice twice;
  drive(twice);
  CHECK(readings == alone);
}

TEST_CASE("A machine that was suspended while the robot drove has stopped it") {
  for (const bool is_long : {false, true}) {
    Bench bench;
    RealRobot robot(bench, bench, bench, {{}, Protocol::kFramed, false});
    Settle(robot, 0.4, bench);
    robot.Arm();
    double suspended_s = 1000.0;
    robot.AddStopper(SuspendStopper(0.25, [&suspended_s] { return suspended_s; }));
    DriveOn(robot, {0.2, 0.2}, 0.3, bench);
    REQUIRE(robot.state() == DriveState::kArmed);
    for (int i = 0; i < 3; ++i) {  // each for itself
      suspended_s += is_long ? 0.26 : 0.24;
      DriveOn(robot, {0.2, 0.2}, 0.1, bench);
    }
    REQUIRE((robot.state() == DriveState::kStopped) == is_long);
    if (!is_long) continue;
    CHECK(robot.Record().stop->reason == StopReason::kHostStalled);
    CHECK(robot.Record().stop->text == "the machine was suspended for 0.3 s");
    CHECK(bench.listener->Motors().IsZero());
  }
  CHECK_FALSE(SuspendStopper(0.25)());  // a test does not outlast a suspend
}

TEST_CASE("A stop is acknowledged by the answer to the zero that goes out with it") {
  Bench bench;
  bench.counts_are_stuck = true;  // so that nothing is to be waited for but the answer
  HardwareOptions hardware;
  hardware.evidence.pushed_m = hardware.evidence.agree_m = 10.0;
  RealRobot robot(bench, bench, bench, {hardware, Protocol::kFramed, false});
  Settle(robot, 0.4, bench);
  for (const int drive : {1, 2}) {
    INFO("drive " << drive);
    robot.Arm();
    DriveOn(robot, {0.2, 0.2}, 0.3, bench);
    bench.Wait(0.045);  // the line is free again
    const double stopped_s = bench.Now_s();
    robot.Stop();
    CHECK(robot.Record().stop_acknowledged == false);
    robot.ConfirmStop(1.0);
    CHECK(robot.Record().stop_acknowledged == true);
    // Twice the radio and the bytes of one command and its answer.
    CHECK(bench.Now_s() - stopped_s == Approx(2 * 0.02 + (11 + 15) * 10.0 / 9600.0).margin(0.005));
  }
}

TEST_CASE("A robot that obeys the stop has acknowledged it once its wheels rest") {
  for (const bool is_stuck : {false, true}) {
    Bench bench;
    RealRobot robot(bench, bench, bench, {{}, Protocol::kFramed, false});
    Settle(robot, 0.4, bench);
    robot.Arm();
    DriveOn(robot, {0.3, 0.3}, 0.6, bench);
    bench.motors_are_stuck = is_stuck;
    const double stopped_s = bench.Now_s();
    robot.Stop();
    robot.ConfirmStop(0.15);
    CHECK(bench.listener->Motors().IsZero());
    CHECK(robot.Record().stop_acknowledged == false);  // it coasts
    robot.ConfirmStop(1.0);
    CHECK(robot.Record().stop_acknowledged == !is_stuck);
    CHECK((bench.Now_s() - stopped_s < 0.7) == !is_stuck);
  }
}

TEST_CASE("A robot whose counts begin anew while it drives has restarted, and is stopped") {
  OnBothSides("left", "right", [](const Side& side) {
    for (const double sign : {1.0, -1.0}) {
      Bench bench;
      RealRobot robot(bench, bench, bench, {{}, Protocol::kFramed, false});
      Settle(robot, 0.4, bench);
      robot.Arm();
      DriveOn(robot, side.Of<WheelPower>(sign * 0.2, sign * 0.15), 0.45, bench);
      REQUIRE(robot.state() == DriveState::kArmed);
      // No farther than two counts of wheels that agree with the pose may be apart.
      const control::EncoderCounts before = *robot.Sense().encoders;
      CHECK(std::max(std::abs(before.left), std::abs(before.right)) < 350);
      bench.BeginCountsAnew();
      DriveOn(robot, side.Of<WheelPower>(sign * 0.2, sign * 0.15), 0.2, bench);
      REQUIRE(robot.Record().stop);
      CHECK(robot.Record().stop->reason == StopReason::kRobotStopped);
      CHECK_THAT(robot.Record().stop->text, Catch::Contains("did the robot restart?"));
    }
  });
}

TEST_CASE("A robot whose motors go on while it is told to stand ends its drive") {
  for (const bool is_dry_run : {false, true}) {
    Bench bench;
    RealRobotOptions options{{}, Protocol::kFramed, false};
    options.dry_run = is_dry_run;
    RealRobot robot(bench, bench, bench, options);
    Settle(robot, 0.4, bench);
    robot.Arm();
    DriveOn(robot, {0.2, 0.2}, 0.6, bench);
    DriveOn(robot, {}, 3.0, bench);
    REQUIRE(robot.state() == DriveState::kArmed);
    DriveOn(robot, {0.2, 0.2}, 0.6, bench);
    bench.motors_are_stuck = true;
    DriveOn(robot, {}, 0.9, bench);
    CHECK(robot.state() == DriveState::kArmed);
    if (is_dry_run) bench.PushWheels(0.1);  // as it is carried along the waypoints
    DriveOn(robot, {}, 0.6, bench);
    CHECK((robot.state() == DriveState::kStopped) == !is_dry_run);
    if (is_dry_run) continue;
    CHECK(robot.Record().stop->reason == StopReason::kRobotDisobeys);
    CHECK_THAT(robot.Record().stop->text, Catch::Contains("while it was told to stand"));
  }
}

TEST_CASE("A robot that is carried before it is armed may be driven") {
  Bench bench;
  RealRobot robot(bench, bench, bench, {{}, Protocol::kFramed, false});
  Settle(robot, 2.0, bench);
  bench.PushWheels(0.1);
  Settle(robot, 0.4, bench);
  robot.Arm();
  DriveOn(robot, {}, 3.0, bench);
  CHECK(robot.state() == DriveState::kArmed);
  bench.PushWheels(0.1);
  DriveOn(robot, {}, 0.2, bench);
  REQUIRE(robot.Record().stop);
  CHECK(robot.Record().stop->reason == StopReason::kRobotDisobeys);
}

TEST_CASE("What the robot did not obey is counted, and so is what was sent and answered") {
  Bench bench;
  RealRobot robot(bench, bench, bench, {{}, Protocol::kFramed, false});
  Settle(robot, 0.5, bench);
  CHECK(robot.Record().rejected_by_robot == 0);
  bench.Chatter("no number\nno number\n");
  Settle(robot, 0.4, bench);
  DriveRecord record = robot.Record();
  CHECK(record.rejected_by_robot == 2);
  CHECK(record.protocol == Protocol::kFramed);
  CHECK(record.answered == record.round_trips_s.size());
  CHECK(record.sent >= record.answered);
  CHECK(record.sent <= record.answered + 3);
  bench.to_robot_is_cut = true;
  Settle(robot, 0.4, bench);
  CHECK(robot.Record().sent > record.sent + 5);
  CHECK(robot.Record().answered <= record.answered + 3);
}

TEST_CASE("A pose that stands is noticed sooner once the latency of the camera is known") {
  for (const bool is_known : {true, false}) {
    Bench bench;
    RealRobot robot(bench, bench, bench, {{}, Protocol::kFramed, false});
    Settle(robot, 0.4, bench);
    robot.Arm();
    if (is_known) robot.SetCameraLatency(0.0);
    DriveOn(robot, {0.2, 0.2}, 0.6, bench);
    REQUIRE(robot.state() == DriveState::kArmed);
    const double frozen_s = bench.Now_s() - 100.0;
    const DriveStop stop = StopOfFrozenPoses(robot, 1.0, bench);
    // 0.24 m/s: 0.012 m and 0.1 s take 0.15 s, with 0.25 s more for a latency 0.4 s.
    CHECK((stop.at_s - frozen_s < 0.3) == is_known);
  }
}

TEST_CASE("The latency of the camera may be set while the robot drives") {
  Bench bench;
  bench.camera_late_s = 0.05;
  RealRobot robot(bench, bench, bench, {{}, Protocol::kFramed, false});
  Settle(robot, 0.6, bench);
  robot.Arm();
  DriveOn(robot, {0.2, 0.2}, 0.8, bench);
  REQUIRE(robot.state() == DriveState::kArmed);
  robot.SetCameraLatency(0.05);
  DriveOn(robot, {0.2, 0.2}, 0.8, bench);
  INFO((robot.Record().stop ? robot.Record().stop->text : std::string("drives")));
  CHECK(robot.state() == DriveState::kArmed);
}

TEST_CASE(
    "A command that is written late counts for the pose that it was decided on, or for none") {
  Bench bench;
  RealRobot robot(bench, bench, bench, {{}, Protocol::kFramed, false});
  Settle(robot, 0.4, bench);
  robot.Arm();
  DriveOn(robot, {0.2, 0.2}, 0.2, bench);
  bench.line_is_blocked = true;
  const size_t before = robot.Record().poses.size();
  while (robot.Record().poses.size() == before) {
    robot.Advance(0.04);
    robot.Sense();
  }
  robot.Command({0.21, 0.2});
  while (robot.Record().poses.size() == before + 1) {
    robot.Advance(0.04);
    robot.Sense();
  }
  const size_t sent = robot.Record().sent;
  bench.line_is_blocked = false;
  for (int i = 0; i < 5; ++i) robot.Advance(0.001);
  CHECK(robot.Record().sent == sent + 1);
  CHECK(bench.written.count({210, 200}) == 1);
  CHECK(robot.Record().poses.back().commanded_s < 0.0);
  CHECK(robot.Record().poses.back().written_s < 0.0);
}

TEST_CASE("On a fast line every power goes out at once, on a slow one the first for each picture") {
  const auto sent_in_a_second = [](int baud) {
    Bench bench;
    HardwareOptions hardware;
    hardware.line.baud = baud;
    RealRobot robot(bench, bench, bench, {hardware, Protocol::kFramed, false});
    Settle(robot, 0.4, bench);
    robot.Arm();
    const size_t before = robot.Record().sent;
    for (int i = 0; bench.Now_s() < 101.4; ++i) {
      robot.Sense();
      robot.Command({0.2 + 0.001 * (i % 7), 0.2});
      robot.Advance(kPeriod_s);
    }
    return robot.Record().sent - before;
  };
  // Thirty pictures a second, and a further step 20 ms after each.
  CHECK(sent_in_a_second(9600) <= 33);
  CHECK(sent_in_a_second(115200) >= 50);
}

TEST_CASE("A pose was answered when its first command was, however many were sent for it") {
  Bench bench;
  HardwareOptions hardware;
  hardware.line.baud = 115200;
  RealRobot robot(bench, bench, bench, {hardware, Protocol::kFramed, false});
  Settle(robot, 0.4, bench);
  robot.Arm();
  for (int i = 0; bench.Now_s() < 101.0; ++i) {
    robot.Sense();
    robot.Command({0.2 + 0.001 * (i % 7), 0.2});
    robot.Advance(kPeriod_s);
  }
  const DriveRecord record = robot.Record();
  CHECK(static_cast<double>(record.sent) > 1.3 * static_cast<double>(record.poses.size()));
  CHECK(CheckSettled(record) > 10);
}

TEST_CASE("A robot whose options break a rule is not made") {
  Bench bench;
  HardwareOptions hardware;
  hardware.line.heartbeat_s = hardware.guard.link_lag_s;
  CHECK_THROWS_AS(RealRobot(bench, bench, bench, {hardware, Protocol::kFramed, false}),
                  std::invalid_argument);
}

TEST_CASE("After its port went away a drive is not armed again") {
  Bench bench;
  RealRobot robot(bench, bench, bench, {{}, Protocol::kFramed, false});
  Settle(robot, 0.4, bench);
  bench.line_is_gone = true;
  Settle(robot, 0.1, bench);
  CHECK(robot.Record().stop->reason == StopReason::kPortGone);
  CHECK(robot.Record().stop->text == "the serial port went away: the test pulled it");
  bench.line_is_gone = false;
  Settle(robot, 0.4, bench);
  CHECK_THROWS_WITH(robot.Arm(), "cannot arm: the serial port went away");
}

TEST_CASE("News are what was recorded since the last news, poses once they are settled") {
  Bench bench;
  RealRobot robot(bench, bench, bench, {{}, Protocol::kFramed, false});
  Settle(robot, 0.4, bench);
  robot.Arm();
  std::vector<PoseStages> poses;
  std::vector<EncoderReading> encoders;
  const auto take = [&] {
    const DriveNews news = robot.TakeNews();
    poses.insert(poses.end(), news.poses.begin(), news.poses.end());
    encoders.insert(encoders.end(), news.encoders.begin(), news.encoders.end());
  };
  for (int i = 0; i < 40; ++i) {
    DriveOn(robot, {0.2, 0.2}, 0.05, bench);
    take();
  }
  const DriveRecord record = robot.Record();
  CHECK(encoders.size() == record.encoders.size());
  REQUIRE(poses.size() > 30);
  CHECK(poses.size() >= record.poses.size() - 5);
  for (size_t i = 0; i < poses.size(); ++i) {
    CHECK(poses[i].captured_s == record.poses[i].captured_s);
    CHECK(poses[i].answered_s == record.poses[i].answered_s);  // nothing comes after it was told
  }
  // Without answers a pose is given up 2.5 s after its picture; the guard has stopped by then.
  bench.from_robot_is_cut = true;
  const size_t before = poses.size();
  DriveOn(robot, {}, 2.48, bench);
  take();
  CHECK(poses.size() <= before + 5);
  DriveOn(robot, {}, 1.0, bench);
  take();
  CHECK(poses.size() > before + 20);
}

}  // namespace
}  // namespace rift::hardware
