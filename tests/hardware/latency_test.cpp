#include "rift/hardware/latency.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "bench.hpp"
#include "hardware/drive_lag.hpp"

namespace rift::hardware {
namespace {

TEST_CASE("A camera's latency is measured by a turn to and fro") {
  for (const double late_s : {0.0, 0.06, 0.12, 0.5, 0.9}) {
    Bench bench;
    bench.camera_late_s = late_s;
    HardwareOptions hardware;
    RealRobot robot(bench, bench, bench, {hardware, Protocol::kFramed, false});
    for (int i = 0; i < 100; ++i) robot.Advance(0.02);
    robot.Arm();
    const std::optional<LatencyResult> found =
        MeasureLatency(robot, hardware.odometry, hardware.turn, 0.04);
    REQUIRE(found);
    INFO("late by " << late_s << " s, measured " << *found->delay.camera_s);
    CHECK(std::abs(*found->delay.camera_s - late_s) < 0.02);
    CHECK(found->turned_deg < 10.0);
    CHECK(*found->delay.robot_s == Approx(0.06).margin(0.04));  // motors of 0.05 s, and the line
    CHECK(std::abs(bench.Pose().yaw_rad) < 0.1);                // it stands as it stood
  }
}

std::optional<LatencyResult> TurnOn(Bench& bench, const HardwareOptions& hardware,
                                    Protocol protocol) {
  RealRobot robot(bench, bench, bench, {hardware, protocol, false});
  for (int i = 0; i < 100; ++i) robot.Advance(0.02);
  robot.Arm();
  return MeasureLatency(robot, hardware.odometry, hardware.turn, 0.04);
}

TEST_CASE("What the robot takes is told from when a pulse begins, and not from a turn before") {
  Bench bench;
  HardwareOptions hardware;
  hardware.line.baud = 115200;  // no command waits for the line; that of the bench is of 9600
  constexpr double kByte_s = 10.0 / 9600.0;
  const double radio_s = bench.line_delay_s + 11 * kByte_s, one_way_s = 0.03;
  // A reading is taken to be of the middle of its round trip, whose way back has more bytes.
  const double late_s = 0.5 * (15 - 11) * kByte_s;
  RealRobot robot(bench, bench, bench, {hardware, Protocol::kFramed, false});
  for (int i = 0; i < 100; ++i) robot.Advance(0.02);
  robot.Arm();
  const auto found = MeasureLatency(robot, hardware.odometry, hardware.turn, one_way_s);
  REQUIRE(found);
  REQUIRE(found->delay.robot_s);
  // From the middle of a pulse to that of the turn of wheels that follow it as the bench's do.
  constexpr double kMotorLag_s = 0.05;
  const double pulse_s = hardware.turn.pulse_s;
  const double coasts_s = kMotorLag_s * (1.0 - std::exp(-pulse_s / kMotorLag_s));
  const double wheels_s = 0.5 * pulse_s + kMotorLag_s * std::log(coasts_s / (0.5 * pulse_s));
  CHECK(*found->delay.robot_s == Approx(wheels_s + radio_s + late_s - one_way_s).margin(0.006));
}

TEST_CASE("A turn to the other side than commanded is refused with what to swap") {
  for (const double late_s : {0.0, 0.1, 0.5}) {
    Bench bench;
    bench.camera_late_s = late_s;
    HardwareOptions hardware;
    hardware.plain.format = "{right:.2f} {left:.2f}\n";
    CHECK_THROWS_WITH(
        TurnOn(bench, hardware, Protocol::kPlain),
        "steered to the left, the robot turned to the right: swap {left} and {right} in "
        "hardware.plain.format, or the plugs of its motors (motors that both run backwards and a "
        "mirrored picture show the same)");
  }
}

TEST_CASE("A picture that turns against wheels that obey is called mirrored") {
  Bench bench;
  bench.bend = [](trial::PoseMeasurement& pose) {
    pose.world_from_robot.yaw_rad = -pose.world_from_robot.yaw_rad;
  };
  CHECK_THROWS_WITH(
      TurnOn(bench, {}, Protocol::kFramed),
      "steered to the left, the wheels turned the robot to the left by their encoders and the "
      "picture shows it turning to the right: the picture is mirrored, or left and right are "
      "swapped at both the motors and the encoders");
}

TEST_CASE("Encoders that answer rarely and late time nothing but the sum of the delays") {
  for (const double late_s : {0.0, 0.12}) {
    Bench bench;
    bench.camera_late_s = late_s;
    const std::optional<LatencyResult> found = TurnOn(bench, {}, Protocol::kPlain);
    REQUIRE(found);
    CHECK_FALSE(found->delay.camera_s);
    INFO("late by " << late_s << " s, measured " << *found->delay.total_s);
    // Line 0.02 s and 9 bytes or so, motors 0.05 s, a turn of the loop.
    CHECK(*found->delay.total_s == Approx(0.09 + late_s).margin(0.05));
  }
}

/// Of a robot that tells no wheels, nothing stops the turn before it is judged.
HardwareOptions Patient() {
  HardwareOptions hardware;
  hardware.evidence.blind_m = hardware.evidence.pushed_m = hardware.evidence.agree_m = 10.0;
  hardware.evidence.pushed_deg = 180.0;
  hardware.evidence.repeats_s = 3600.0;
  hardware.evidence.max_latency_s = 2.0;
  return hardware;
}

TEST_CASE("Pulses that move nothing before one that does are no lag of the picture") {
  for (const double late_s : {0.0, 0.1}) {
    Bench bench;
    bench.from_robot_is_cut = true;
    bench.camera_late_s = late_s;
    // The motors' friction: a weak turn is none.
    bench.bend = [](trial::PoseMeasurement& pose) {
      constexpr double kStuck_rad = 0.2;
      double& yaw_rad = pose.world_from_robot.yaw_rad;
      yaw_rad = std::copysign(std::max(0.0, std::abs(yaw_rad) - kStuck_rad), yaw_rad);
    };
    const std::optional<LatencyResult> found = TurnOn(bench, Patient(), Protocol::kPlain);
    REQUIRE(found);
    INFO("late by " << late_s << " s, measured " << *found->delay.total_s);
    CHECK(*found->delay.total_s == Approx(0.09 + late_s).margin(0.05));
  }
}

TEST_CASE("A picture later than the search goes is no delay of 1.2 s") {
  Bench bench;
  bench.from_robot_is_cut = true;
  bench.camera_late_s = 1.3;
  CHECK_THROWS_WITH(TurnOn(bench, Patient(), Protocol::kPlain),
                    Catch::Contains("and not how long after the commands within 1.2 s") &&
                        Catch::Contains("(the best fit is 0.769 s late and 2.6 deg off)") &&
                        Catch::Contains("hardware.turn.power is 0.08"));
}

TEST_CASE("A picture that turns before it is commanded to has no lag behind the commands") {
  Bench bench;
  bench.from_robot_is_cut = true;
  bench.bend = [](trial::PoseMeasurement& pose) { pose.captured_s -= 0.15; };
  HardwareOptions hardware = Patient();
  hardware.guard.pose_stale_s = 1.0;
  CHECK_THROWS_WITH(TurnOn(bench, hardware, Protocol::kPlain),
                    Catch::Contains("and not how long after the commands within 1.2 s (the best "
                                    "fit is 0.000 s late and "));
}

TEST_CASE("A picture that turns at times of its own has no lag behind the commands") {
  for (const double period_s : {0.7, 1.1}) {
    Bench bench;
    bench.from_robot_is_cut = true;
    bench.bend = [period_s](trial::PoseMeasurement& pose) {
      pose.world_from_robot.yaw_rad = 0.1 * std::sin(6.283 * pose.captured_s / period_s);
    };
    INFO("period " << period_s << " s");
    CHECK_THROWS_WITH(TurnOn(bench, Patient(), Protocol::kPlain),
                      (Catch::Contains("and not clearly to which side: this machine is too busy") ||
                       Catch::Contains("and not how long after the commands")) &&
                          !Catch::Contains("swap {left}") && !Catch::Contains("mirrored"));
  }
}

/// Now and then no picture comes for long, and then one that is as old; never an older one than
/// before.
void Stall(Bench& bench) {
  bench.bend = [yaws_rad = std::vector<double>{},
                shown = size_t{0}](trial::PoseMeasurement& pose) mutable {
    yaws_rad.push_back(pose.world_from_robot.yaw_rad);
    const size_t late = yaws_rad.size() % 23;
    shown = std::max(shown, yaws_rad.size() - 1 - std::min(late, yaws_rad.size() - 1));
    pose.world_from_robot.yaw_rad = yaws_rad[shown];
  };
}

TEST_CASE(
    "Pictures that come as a busy machine lets them are called uneven, and no side is named") {
  Bench bench;
  Stall(bench);
  CHECK_THROWS_WITH(TurnOn(bench, {}, Protocol::kFramed),
                    Catch::Contains("but not when they did: this machine is too busy"));
}

TEST_CASE("A robot that turns to the other side is refused whatever the pictures are like") {
  Bench bench;
  Stall(bench);
  HardwareOptions hardware;
  hardware.plain.format = "{right:.2f} {left:.2f}\n";
  CHECK_THROWS_WITH(TurnOn(bench, hardware, Protocol::kPlain),
                    Catch::Contains("the robot turned to the right: swap {left} and {right}") ||
                        Catch::Contains("and not clearly to which side") ||
                        Catch::Contains("and not how long after the commands"));
}

TEST_CASE("A picture that is ahead of its wheels is refused") {
  Bench bench;
  // The stamps of the pictures are 0.08 s too early.
  bench.bend = [](trial::PoseMeasurement& pose) { pose.captured_s -= 0.08; };
  CHECK_THROWS_WITH(TurnOn(bench, {}, Protocol::kFramed),
                    Catch::Contains("before the encoders do, which cannot be"));
}

/// A turn to and fro that never repeats itself, scaled and late.
std::vector<Angle> Swing(double late_s, double scale, double offset_rad, double every_s) {
  std::vector<Angle> angles;
  for (double t_s = 0.0; t_s < 6.0; t_s += every_s) {
    const double own_s = t_s - late_s;
    AddAngle(
        angles, t_s,
        offset_rad + scale * (0.3 * std::sin(2.1 * own_s) + 0.2 * std::sin(5.3 * own_s + 0.4)));
  }
  return angles;
}

TEST_CASE("A lag is found with its scale, between its steps and at both ends of the search") {
  const std::vector<Angle> leader = Swing(0.0, 1.0, 0.0, 0.01);
  for (const double lag_s : {-0.2, 0.0, 0.0733, 0.2218, 0.4}) {
    const std::optional<Lag> found = EstimateLag(Swing(lag_s, 0.8, 0.5, 0.033), leader, -0.2, 0.4);
    REQUIRE(found);
    INFO("lag " << lag_s);
    CHECK(found->lag_s == Approx(lag_s).margin(0.002));
    CHECK(found->scale == Approx(0.8).margin(0.03));
  }
  CHECK(EstimateLag(Swing(0.3, -1.0, 0.0, 0.033), leader, 0.2, 0.4)->scale ==
        Approx(-1.0).margin(0.02));
  CHECK_FALSE(EstimateLag(Swing(0.0, 0.0, 0.5, 0.033), leader, -0.2, 0.4));
  CHECK_FALSE(EstimateLag(leader, Swing(0.0, 0.0, 0.5, 0.033), -0.2, 0.4));
}

TEST_CASE("The lag over a drive is told where it is clear, and else none is") {
  const std::vector<Angle> wheels = Swing(0.0, 1.0, 0.0, 0.01);
  const auto over = [&wheels](double late_s, double scale) {
    return LagOverDrive(Swing(late_s, scale, 0.5, 0.033), wheels);
  };
  for (const double late_s : {-0.05, 0.0, 0.12, 0.6}) {
    REQUIRE(over(late_s, 0.9));
    CHECK(*over(late_s, 0.9) == Approx(late_s).margin(0.005));
  }
  CHECK(over(0.1, 0.42));
  CHECK_FALSE(over(0.1, 0.38));
  CHECK(over(0.1, 2.4));
  CHECK_FALSE(over(0.1, 2.6));
  CHECK_FALSE(over(1.1, 1.0));  // the search ends at 1 s
  CHECK_FALSE(over(-1.1, 1.0));
}

TEST_CASE("The lag over a drive is told up to a second to either side, and not at its very end") {
  // One turn and back, from 2 s to 4 s, with rest on both sides of it.
  const auto turn = [](double late_s, double every_s) {
    std::vector<Angle> angles;
    for (int i = 0; every_s * i < 6.0; ++i) {
      const double since_s = std::clamp(every_s * i - late_s - 2.0, 0.0, 2.0);
      angles.push_back(
          {every_s * i, 0.3 * since_s * std::pow(std::sin(0.5 * 3.14159 * since_s), 2)});
    }
    return angles;
  };
  for (const double sign : {1.0, -1.0}) {
    const auto over = [&](double late_s) {
      return LagOverDrive(turn(sign * late_s, 0.02), turn(0.0, 0.02));
    };
    REQUIRE(over(0.97));
    CHECK(*over(0.97) == Approx(sign * 0.97).margin(0.003));
    CHECK(over(0.9925));  // 5 ms before the end of the search
    CHECK_FALSE(over(0.9965));
    CHECK_FALSE(over(0.9985));
  }
}

TEST_CASE("A drive with hardly a turn, or whose turns are not the wheels', tells no lag") {
  const auto swing = [](double rad, double late_s, double every_s) {
    std::vector<Angle> angles = Swing(late_s, 1.0, 0.0, every_s);
    double low = 0.0, high = 0.0;
    for (const Angle& angle : angles) {
      low = std::min(low, angle.rad);
      high = std::max(high, angle.rad);
    }
    for (Angle& angle : angles) angle.rad *= rad / (high - low);
    return angles;
  };
  const double least_rad = geometry::RadFromDeg(5.0);
  for (const double share : {0.98, 1.06}) {
    const std::vector<Angle> turns = swing(share * least_rad, 0.0, 0.01);
    CHECK(LagOverDrive(swing(share * least_rad, 0.1, 0.033), turns).has_value() == (share > 1.0));
  }
  // Both must turn so far: of the same turn the camera may show less than the wheels, or more.
  const auto of = [&](double seen, double turned) {
    return LagOverDrive(swing(seen * least_rad, 0.1, 0.033), swing(turned * least_rad, 0.0, 0.01));
  };
  CHECK_FALSE(of(0.95, 1.3));
  CHECK_FALSE(of(1.3, 0.95));
  CHECK(of(1.1, 1.5));
  CHECK(of(1.5, 1.1));
  // The camera sees the turn, and another one on top of it.
  const std::vector<Angle> wheels = swing(0.6, 0.0, 0.01);
  // What is left of a fit is up to a quarter of all that it sees turn: 0.24 and 0.27 of it here.
  for (const double other_rad : {0.5, 0.8}) {
    std::vector<Angle> seen = swing(0.6, 0.1, 0.033);
    for (Angle& angle : seen) angle.rad += other_rad * std::sin(11.0 * angle.t_s);
    CHECK(LagOverDrive(seen, wheels).has_value() == (other_rad < 0.6));
  }
  CHECK_FALSE(LagOverDrive({}, wheels));
  CHECK_FALSE(LagOverDrive(wheels, {}));
}

TEST_CASE("A turn of exactly 0.09 rad, by wheels and by the picture, tells a lag") {
  // There and back, from 2 s to 4 s.
  const auto turn = [](double late_s, double rad) {
    std::vector<Angle> angles;
    for (int i = 0; i < 300; ++i) {
      const double since_s = std::clamp(0.02 * i - late_s - 2.0, 0.0, 2.0);
      angles.push_back({0.02 * i, rad * std::min(1.0, 1.25 * std::min(since_s, 2.0 - since_s))});
    }
    return angles;
  };
  constexpr double kLeast_rad = 0.09;
  const auto lag_s = LagOverDrive(turn(0.1, kLeast_rad), turn(0.0, kLeast_rad));
  REQUIRE(lag_s);
  CHECK(*lag_s == Approx(0.1).margin(0.003));
  const double less_rad = std::nextafter(kLeast_rad, 0.0);
  CHECK_FALSE(LagOverDrive(turn(0.1, less_rad), turn(0.0, kLeast_rad)));
  CHECK_FALSE(LagOverDrive(turn(0.1, kLeast_rad), turn(0.0, less_rad)));
}

TEST_CASE("An angle runs on through half a turn in both directions") {
  for (const double sign : {1.0, -1.0}) {
    std::vector<Angle> angles;
    for (int i = 0; i <= 20; ++i) {
      const double rad = sign * 0.5 * i;
      AddAngle(angles, 0.1 * i, std::atan2(std::sin(rad), std::cos(rad)));
    }
    CHECK(angles.back().rad == Approx(sign * 10.0));
  }
}

TEST_CASE("The turn of the wheels is that of the right one less that of the left one") {
  const std::vector<EncoderReading> readings{{0.0, {100, 50}}, {0.1, {110, 90}}, {0.1, {0, 0}}};
  const std::vector<Angle> turns = WheelTurns(readings, 0.01);
  REQUIRE(turns.size() == 2);
  CHECK(turns[0].rad == Approx(-0.5));
  CHECK(turns[1].rad == Approx(-0.2));
  CHECK(turns[1].t_s == 0.1);
}

}  // namespace
}  // namespace rift::hardware
