// Each rule of the controllers at its bound, just inside and just outside.
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <limits>

#include "rift/control/navigator.hpp"
#include "rift/control/pose_filter.hpp"
#include "rift/control/program_controller.hpp"
#include "rift/geometry/pose2.hpp"

namespace rift::control {
namespace {

using geometry::Pose2;
using geometry::RadFromDeg;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

TEST_CASE("A pose is believed up to the speed and the turn of the gate, to every side") {
  const PoseGateOptions options{.max_speed_mps = 2.0, .max_yaw_rate_rad_s = 10.0};
  const auto is_believed = [&](const Pose2& step, double after_s) {
    PoseGate gate(options);
    REQUIRE(gate.Accept({5.0, {1.0, -1.0, 3.0}}));
    return gate.Accept({5.0 + after_s, {1.0 + step.x_m, -1.0 + step.y_m, 3.0 + step.yaw_rad}});
  };
  for (const double sign : {1.0, -1.0}) {
    CHECK(is_believed({sign * 0.1999, 0.0, 0.0}, 0.1));
    CHECK_FALSE(is_believed({sign * 0.2001, 0.0, 0.0}, 0.1));
    CHECK(is_believed({0.0, sign * 0.1999, 0.0}, 0.1));
    CHECK_FALSE(is_believed({0.0, sign * 0.2001, 0.0}, 0.1));
    CHECK_FALSE(is_believed({sign * 0.15, sign * 0.15, 0.0}, 0.1));
    CHECK(is_believed({0.0, 0.0, sign * 0.999}, 0.1));  // across the jump at half a turn
    CHECK_FALSE(is_believed({0.0, 0.0, sign * 1.001}, 0.1));
  }
  CHECK(is_believed({0.0399, 0.0, 0.0}, 0.001));  // shorter intervals count as 0.02 s
  CHECK_FALSE(is_believed({0.0401, 0.0, 0.0}, 0.001));
  CHECK(is_believed({0.0, 0.0, 0.0}, 0.0));
  CHECK_FALSE(is_believed({0.0, 0.0, 0.0}, -0.001));
}

TEST_CASE("A pose off the map, or without a number or a time, is not believed") {
  const auto is_believed = [](double t_s, const Pose2& pose) {
    return PoseGate(PoseGateOptions{}).Accept({t_s, pose});
  };
  CHECK(is_believed(0.0, {0.99e5, -0.99e5, 0.0}));
  for (const double far_m : {1.01e5, -1.01e5, kNan, HUGE_VAL}) {
    CHECK_FALSE(is_believed(0.0, {far_m, 0.0, 0.0}));
    CHECK_FALSE(is_believed(0.0, {0.0, far_m, 0.0}));
  }
  CHECK_FALSE(is_believed(0.0, {0.0, 0.0, kNan}));
  CHECK_FALSE(is_believed(kNan, {}));
  CHECK_FALSE(is_believed(HUGE_VAL, {}));
}

TEST_CASE("A refused pose leaves the one before in force") {
  PoseGate gate(PoseGateOptions{});
  CHECK_FALSE(gate.last());
  gate.Accept({1.0, {0.1, 0.0, 0.0}});
  gate.Accept({1.1, {9.0, 0.0, 0.0}});
  CHECK(gate.last()->captured_s == 1.0);
  CHECK(gate.last()->world_from_robot.x_m == 0.1);
}

/// What the navigator decides at the origin, looking along x, with a target at this distance and
/// to this side.
Decision Towards(const NavigatorOptions& options, double distance_m, double left_deg,
                 bool stop = true, double dt_s = 0.05) {
  const double angle_rad = RadFromDeg(left_deg);
  Navigator navigator(options, {{.name = "s", .x_m = -1.0},
                                {.name = "t",
                                 .x_m = distance_m * std::cos(angle_rad),
                                 .y_m = distance_m * std::sin(angle_rad),
                                 .stop = stop},
                                {.name = "e", .x_m = 50.0, .stop = true}});
  return navigator.Step({0.0, dt_s, 0.0, {0.0, 0.0, 0.0}});
}

NavigatorOptions Plain() {
  NavigatorOptions options;
  options.distance = {0.5, 0.0, 0.0};
  options.heading = {0.4, 0.0, 0.0};
  options.v_min = 0.1;
  options.v_max = 0.4;
  options.w_min = 0.05;
  options.w_max = 0.3;
  return options;
}

TEST_CASE("A waypoint is reached below its radius, and not at it") {
  NavigatorOptions options = Plain();
  options.reach_radius_m = 0.0625;
  CHECK_FALSE(Towards(options, 0.0625, 0.0).reached);
  CHECK(Towards(options, std::nextafter(0.0625, 0.0), 0.0).reached);
}

TEST_CASE("Forward and steering powers are limited at both ends, and told only beyond them") {
  const NavigatorOptions options = Plain();
  const Decision slow = Towards(options, 0.16, 0.0), middle = Towards(options, 0.5, 0.0),
                 fast = Towards(options, 0.9, 0.0);
  CHECK(slow.raw_v == Approx(0.08));
  CHECK(slow.v == 0.1);
  CHECK(slow.limits.v_min);
  CHECK_FALSE(slow.limits.v_max);
  CHECK(middle.v == Approx(0.25));
  CHECK_FALSE(middle.limits.v_min);
  CHECK_FALSE(middle.limits.v_max);
  CHECK(fast.v == 0.4);
  CHECK(fast.limits.v_max);
  for (const double side : {1.0, -1.0}) {
    const double little_deg = side * 4.0, some_deg = side * 30.0, much_deg = side * 60.0;
    const Decision little = Towards(options, 0.5, little_deg),
                   some = Towards(options, 0.5, some_deg), much = Towards(options, 0.5, much_deg);
    CHECK(little.w == Approx(side * 0.05));
    CHECK(little.limits.w_min);
    CHECK(some.w == Approx(0.4 * RadFromDeg(some_deg)));
    CHECK_FALSE(some.limits.w_min);
    CHECK_FALSE(some.limits.w_max);
    CHECK(much.w == Approx(side * 0.3));
    CHECK(much.limits.w_max);
    CHECK(some.power.left == Approx(some.v - some.w));
    CHECK(some.power.right == Approx(some.v + some.w));
    CHECK(some.heading_error_rad == Approx(RadFromDeg(some_deg)));
  }
}

TEST_CASE("The cruise speed caps below its angle, and is kept to a waypoint without stop") {
  NavigatorOptions options = Plain();
  options.cruise_speed = 0.2;
  options.cruise_cap_angle_deg = 15.0;
  options.through_angle_deg = 10.0;
  for (const double side : {1.0, -1.0}) {
    CHECK(Towards(options, 0.7, side * 14.9).limits.cruise_cap);
    CHECK(Towards(options, 0.7, side * 14.9).v == Approx(0.2));
    CHECK_FALSE(Towards(options, 0.7, side * 15.1).limits.cruise_cap);
    CHECK(Towards(options, 0.7, side * 15.1).v == Approx(0.35));
    CHECK(Towards(options, 0.3, side * 9.9, false).limits.through_cruise);
    CHECK(Towards(options, 0.3, side * 9.9, false).v == Approx(0.2));
    CHECK_FALSE(Towards(options, 0.3, side * 10.1, false).limits.through_cruise);
    CHECK(Towards(options, 0.3, side * 10.1, false).v == Approx(0.15));
    CHECK_FALSE(Towards(options, 0.3, side * 9.9, true).limits.through_cruise);
  }
  CHECK_FALSE(Towards(options, 0.3, 0.0).limits.cruise_cap);  // slower than cruise
}

TEST_CASE("Time steps are held within their bounds, and one that is none counts as the longest") {
  NavigatorOptions options = Plain();
  options.heading = {0.0, 0.0, 0.001};  // the derivative kick: error over the step
  options.w_min = 0.0;
  options.dt_min_s = 0.01;
  options.dt_max_s = 0.1;
  const auto w = [&](double dt_s) { return Towards(options, 0.5, 30.0, true, dt_s).raw_w; };
  const double error_rad = RadFromDeg(30.0);
  CHECK(w(0.05) == Approx(0.001 * error_rad / 0.05));
  CHECK(w(0.001) == Approx(0.001 * error_rad / 0.01));
  CHECK(w(-1.0) == Approx(0.001 * error_rad / 0.01));
  CHECK(w(5.0) == Approx(0.001 * error_rad / 0.1));
  CHECK(w(kNan) == Approx(0.001 * error_rad / 0.1));
  CHECK(w(HUGE_VAL) == Approx(0.001 * error_rad / 0.1));
}

TEST_CASE("Powers beyond one are scaled by the larger wheel, whichever it is") {
  NavigatorOptions options = Plain();
  options.heading.p = 3.0;
  options.w_max = 1.0;
  options.v_min = options.v_max = 0.5;
  for (const double side : {1.0, -1.0}) {
    const Decision decision = Towards(options, 0.5, side * 50.0);
    CHECK(decision.w == Approx(side));
    CHECK(decision.limits.normalised);
    const double outer = side > 0.0 ? decision.power.right : decision.power.left;
    const double inner = side > 0.0 ? decision.power.left : decision.power.right;
    CHECK(outer == Approx(1.0));
    CHECK(inner == Approx(-0.5 / 1.5));
  }
  options.v_min = options.v_max = 0.3;
  options.heading.p = 0.4;
  CHECK_FALSE(Towards(options, 0.5, 50.0).limits.normalised);
}

TEST_CASE("The slew limit holds each wheel by itself, up and down") {
  NavigatorOptions options = Plain();
  options.slew_rate_per_s = 2.0;  // 0.1 in a step of 0.05 s
  Navigator navigator(options, {{.name = "s"}, {.name = "t", .x_m = 0.8, .stop = true}});
  navigator.NoteSent(-0.05, {0.35, 0.9});
  const Decision decision = navigator.Step({0.0, 0.05, 0.0, {0.0, 0.0, 0.0}});
  CHECK(decision.power.left == Approx(0.4));   // within reach
  CHECK(decision.power.right == Approx(0.8));  // wanted 0.4
  CHECK(decision.limits.slew);
  navigator.NoteSent(0.0, {0.4, 0.4});
  CHECK_FALSE(navigator.Step({0.05, 0.05, 0.05, {0.0, 0.0, 0.0}}).limits.slew);
  navigator.NoteSent(0.05, {0.1, 0.35});
  const Decision rises = navigator.Step({0.1, 0.05, 0.1, {0.0, 0.0, 0.0}});
  CHECK(rises.power.left == Approx(0.2));
  CHECK(rises.power.right == Approx(0.4));
}

TEST_CASE("The slew limit changes nothing of powers that stay, different as they are") {
  NavigatorOptions options = Plain();
  const std::vector<Waypoint> way{{.name = "s", .x_m = -1.0},
                                  {.name = "t", .x_m = 0.4, .y_m = 0.25, .stop = true}};
  const PoseInput input{0.0, 0.05, 0.0, {0.0, 0.0, 0.0}};
  const WheelPower wanted = Navigator(options, way).Step(input).power;
  REQUIRE(wanted.right - wanted.left > 0.3);
  options.slew_rate_per_s = 2.0;
  Navigator navigator(options, way);
  navigator.NoteSent(-0.05, wanted);
  const Decision decision = navigator.Step(input);
  CHECK(decision.power == wanted);
  CHECK_FALSE(decision.limits.slew);
}

TEST_CASE("A pose that is seen again is as old as when it came in") {
  NavigatorOptions options = Plain();
  options.latency.delay_s = 0.3;
  options.latency.drive.wheel_radius_m = 0.1;
  options.latency.drive.full_power_speed_rad_s = 10.0;  // 1 m/s at full power
  Navigator navigator(options, {{.name = "s", .x_m = -1.0}, {.name = "t", .x_m = 2.0}});
  navigator.NoteSent(0.0, {0.5, 0.5});
  CHECK(navigator.Step({1.0, 0.05, 0.9, {0.0, 0.0, 0.0}}).distance_m == Approx(2.0 - 0.15));
  CHECK(navigator.Step({1.2, 0.05, 0.9, {0.0, 0.0, 0.0}}).distance_m == Approx(2.0 - 0.25));
  CHECK(navigator.Step({1.3, 0.05, 1.25, {0.0, 0.0, 0.0}}).distance_m == Approx(2.0 - 0.15));
}

TEST_CASE("A drive has lengths and a speed that are finite and above zero, or is refused") {
  for (const double wrong : {0.0, -1.0, kNan, HUGE_VAL}) {
    CHECK_THROWS_WITH(DiffDrive({.wheel_radius_m = wrong}),
                      Catch::StartsWith("wheel_radius_m is ") &&
                          Catch::EndsWith("and it must be finite and above zero"));
    CHECK_THROWS_WITH(DiffDrive({.track_m = wrong}), Catch::StartsWith("track_m is "));
    CHECK_THROWS_WITH(DiffDrive({.full_power_speed_rad_s = wrong}),
                      Catch::StartsWith("full_power_speed_rad_s is "));
  }
}

TEST_CASE("Waypoints lie within a kilometre, with a heading that is a number") {
  const auto refusal = [](double x_m, double y_m, double heading_deg) -> std::string {
    try {
      CheckWaypoints(
          {{.name = "s"}, {.name = "t", .x_m = x_m, .y_m = y_m, .heading_deg = heading_deg}});
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  };
  CHECK(refusal(1000.0, -1000.0, 720.0).empty());
  CHECK(refusal(1000.1, 0.0, 0.0) ==
        "waypoint 2 't' at x 1000.1, y 0, heading 0 must be finite and within 1000 m");
  CHECK_FALSE(refusal(0.0, -1000.1, 0.0).empty());
  CHECK_FALSE(refusal(kNan, 0.0, 0.0).empty());
  CHECK_FALSE(refusal(0.0, HUGE_VAL, 0.0).empty());
  CHECK_FALSE(refusal(0.0, 0.0, kNan).empty());
  CHECK_THROWS_WITH(CheckWaypoints({{.name = "s"}}),
                    "1 waypoint(s) given: a start and at least one more are needed");
  CHECK(StartPose({{.name = "s", .x_m = 1.0, .y_m = 2.0, .heading_deg = 270.0}, {.name = "t"}}) ==
        Pose2{1.0, 2.0, geometry::WrapToPi(RadFromDeg(270.0))});
  CHECK(StartPose({{.name = "s", .x_m = 1.0}, {.name = "t", .x_m = 1.0, .y_m = -2.0}}).yaw_rad ==
        Approx(RadFromDeg(-90.0)));
  const Pose2 start = StartPose({{.name = "s", .x_m = 1.0, .y_m = 2.0}, {.name = "t"}});
  CHECK(start.x_m == 1.0);
  CHECK(start.y_m == 2.0);
  CHECK_THROWS_AS(StartPose({{.name = "s"}}), std::invalid_argument);
  CHECK_THROWS_WITH(CheckWaypoints({{.name = "s", .x_m = 1000.1}, {.name = "t"}}),
                    "waypoint 1 's' at x 1000.1, y 0, heading 0 must be finite and within 1000 m");
}

TEST_CASE("Options outside their range, or in the wrong order, are refused by name and value") {
  const auto refusal = [](const std::function<void(NavigatorOptions&)>& change) -> std::string {
    NavigatorOptions options;
    change(options);
    try {
      options.Check();
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  };
  CHECK(refusal([](NavigatorOptions&) {}).empty());
  CHECK(refusal([](NavigatorOptions& o) { o.v_max = 1.1; }) ==
        "v_max is 1.1, and it must lie in [0, 1]");
  CHECK(refusal([](NavigatorOptions& o) { o.v_min = -0.1; }) ==
        "v_min is -0.1, and it must lie in [0, 1]");
  CHECK(refusal([](NavigatorOptions& o) {
          o.reach_radius_m = kNan;
        }).starts_with("reach_radius_m is nan, and it must lie in"));
  CHECK(refusal([](NavigatorOptions& o) {
          o.cruise_speed = 2.0;
        }).starts_with("cruise_speed is 2, and it must lie in"));
  CHECK(refusal([](NavigatorOptions& o) {
          o.v_min = 0.4, o.v_max = 0.3;
        }).starts_with("v_min is 0.4, and it must not exceed v_max, which is 0.3"));
  CHECK(refusal([](NavigatorOptions& o) {
          o.w_min = 0.4, o.w_max = 0.3;
        }).starts_with("w_min is 0.4, and it must not exceed w_max, which is 0.3"));
  CHECK(refusal([](NavigatorOptions& o) {
          o.cruise_speed = 0.1;
        }).starts_with("v_min is 0.15, and it must not exceed cruise_speed, which is 0.1"));
  CHECK(refusal([](NavigatorOptions& o) {
          o.cruise_speed = 0.35;
        }).starts_with("cruise_speed is 0.35, and it must not exceed v_max, which is 0.3"));
  CHECK(refusal([](NavigatorOptions& o) {
          o.dt_min_s = 0.2;
        }).starts_with("dt_min_s is 0.2, and it must not exceed dt_max_s, which is 0.1"));
  CHECK(refusal([](NavigatorOptions& o) { o.v_min = o.v_max, o.w_min = o.w_max; }).empty());
}

TEST_CASE("The published gains and limits of the authors are the defaults") {
  const NavigatorOptions options;
  CHECK(options.distance.p == 0.9);
  CHECK(options.distance.i == 0.0);
  CHECK(options.distance.d == 0.01);
  CHECK(options.heading.p == 0.045);
  CHECK(options.heading.i == 0.0);
  CHECK(options.heading.d == 0.0085);
  CHECK(options.integral_limit == 2.0);
  CHECK(options.reach_radius_m == 0.05);
  CHECK(options.v_min == 0.15);
  CHECK(options.v_max == 0.30);
  CHECK(options.w_min == 0.02);
  CHECK(options.w_max == 0.5);
  CHECK(options.cruise_cap_angle_deg == 15.0);
  CHECK(options.through_angle_deg == 10.0);
  CHECK(options.dt_min_s == 0.005);
  CHECK(options.dt_max_s == 0.1);
  CHECK(options.CruiseSpeed() == 0.30);
  CHECK_FALSE(options.slew_rate_per_s);
  CHECK(options.derivative_kick);
  CHECK_FALSE(options.first_pose_sets_clock);
  CHECK_FALSE(options.clock_starts_anew);
}

DiffDriveOptions Metre() {
  DiffDriveOptions drive;
  drive.wheel_radius_m = 0.1;
  drive.full_power_speed_rad_s = 10.0;  // 1 m/s at full power
  drive.track_m = 0.2;
  return drive;
}

TEST_CASE("A predicted pose has driven what was sent between its delay and now, and nothing else") {
  LatencyOptions options;
  options.delay_s = 0.3;
  options.drive = Metre();
  PosePredictor predictor(options);
  predictor.NoteSent(0.0, {0.5, 0.5});
  predictor.NoteSent(1.0, {1.0, 1.0});
  predictor.NoteSent(2.0, {0.0, 0.0});
  // Arrived at 1.2: commands from 0.9 on are unseen. Until 1.5: 0.1 s of half, 0.5 s of full power.
  CHECK(predictor.Predict({0.0, 0.0, 0.0}, 1.2, 1.5).x_m == Approx(0.05 + 0.5));
  CHECK(predictor.Predict({0.0, 0.0, 0.0}, 1.2, 2.5).x_m == Approx(0.05 + 1.0));
  CHECK(predictor.Predict({0.0, 0.0, 0.0}, 2.5, 2.5).x_m == Approx(0.0));
  CHECK(predictor.Predict({0.0, 0.0, 0.0}, 0.1, 0.2).x_m == Approx(0.1));
  predictor.NoteSent(20.0, {0.0, 0.0});  // what is long past is forgotten, save the last before
  CHECK(predictor.Predict({0.0, 0.0, 0.0}, 1.2, 1.5).x_m == Approx(0.0));
  options.delay_s = 0.0;
  PosePredictor off(options);
  off.NoteSent(0.0, {1.0, 1.0});
  CHECK(off.Predict({0.5, 0.0, 0.0}, 1.0, 2.0).x_m == 0.5);
}

TEST_CASE("A program's pieces have their powers, lengths and times, to either side") {
  ProgramOptions options{.power = 0.5, .laps = 1};
  options.rest_s = 0.25;
  options.segments = {{.straight_m = 1.0},
                      {.turn_deg = 90.0, .radius_m = 0.4},
                      {.hold_s = 1.5},
                      {.turn_deg = -90.0},
                      {.straight_m = -0.5, .power = 0.25}};
  const Program program(options, Metre(), {});
  const double arc_s = 0.5 * geometry::kPi * 0.5 / 0.5, spot_s = 0.5 * geometry::kPi * 0.1 / 0.5;
  CHECK(program.Duration_s() == Approx(2.0 + arc_s + 1.5 + spot_s + 2.0));
  CHECK(program.Rest_s() == 0.25);
  const auto power = [&](double t_s) { return program.MeanPower(t_s, t_s + 0.01); };
  CHECK(power(1.0).left == Approx(0.5));
  CHECK(power(1.0).right == Approx(0.5));
  CHECK(power(2.5).right == Approx(0.5));  // the outer wheel of a turn to the left
  CHECK(power(2.5).left == Approx(0.5 * 0.3 / 0.5));
  CHECK(power(2.0 + arc_s + 0.5).left == 0.0);
  CHECK(power(2.0 + arc_s + 1.55).left == Approx(0.5));  // on the spot to the right
  CHECK(power(2.0 + arc_s + 1.55).right == Approx(-0.5));
  CHECK(power(program.Duration_s() - 0.5).left == Approx(-0.25));
  CHECK(power(program.Duration_s() + 0.1).left == 0.0);
  CHECK(program.MeanPower(1.0, 1.0).left == 0.0);
  CHECK(program.MeanPower(program.Duration_s() - 0.1, program.Duration_s() + 0.3).left ==
        Approx(-0.25 / 4.0));
  const Pose2 corner = program.PoseAt(2.0 + arc_s);
  CHECK(corner.x_m == Approx(1.4));
  CHECK(corner.y_m == Approx(0.4));
  CHECK(corner.yaw_rad == Approx(geometry::kPi / 2.0));
  const Pose2 end = program.PoseAt(99.0);
  CHECK(end.x_m == Approx(0.9));
  CHECK(end.y_m == Approx(0.4));
  CHECK(end.yaw_rad == Approx(0.0).margin(1e-12));
  REQUIRE(program.waypoints().size() == 6);
  CHECK(program.waypoints()[0].name == "start");
  CHECK(program.waypoints()[1].name == "straight 1 m");
  CHECK(program.waypoints()[2].name == "arc 90 deg, 0.4 m");
  CHECK(program.waypoints()[3].name == "hold 1.5 s");
  CHECK(program.waypoints()[4].name == "turn -90 deg");
  CHECK(program.waypoints()[5].x_m == Approx(0.9));
  const std::vector<double> times = program.Times(0.5);
  CHECK(times.front() == 0.0);
  CHECK(times.back() == Approx(program.Duration_s()));
  CHECK(times[1] == Approx(0.5));
  for (size_t i = 1; i < times.size(); ++i) CHECK(times[i] - times[i - 1] <= 0.5 + 1e-12);
  CHECK(program.Times(100.0).size() == 6);  // the ends of its pieces
}

TEST_CASE("The most power of a program is that of its faster wheel, to either side") {
  for (const double turn_deg : {90.0, -90.0}) {
    ProgramOptions options{.power = 0.25, .laps = 1};
    options.segments = {{.turn_deg = turn_deg, .radius_m = 0.3}};
    CHECK(Program(options, Metre(), {}).MostPower() == Approx(0.25));
  }
}

TEST_CASE("A program faster than the wheels, or a segment of two kinds, is refused") {
  ProgramOptions options{.laps = 1};
  options.segments = {{.straight_m = 1.0}};
  options.speed_mps = 1.0;
  CHECK_NOTHROW(Program(options, Metre(), {}));
  options.speed_mps = 1.01;
  CHECK_THROWS_WITH(
      Program(options, Metre(), {}),
      "program.speed_mps is 1.01, and the robot's wheels make 1.000 m/s at full power "
      "(hardware.odometry.drive)");
  const auto refusal = [](const Segment& segment) -> std::string {
    try {
      segment.Check();
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  };
  CHECK(refusal({}) ==
        "a segment is one of straight_m, turn_deg and hold_s, and 0 of them are set");
  CHECK(refusal({.straight_m = 1.0, .hold_s = 1.0}).find("and 2 of them") != std::string::npos);
  CHECK(refusal({.straight_m = 1.0, .turn_deg = 1.0, .hold_s = 1.0}).find("and 3 of them") !=
        std::string::npos);
  CHECK(refusal({.straight_m = 1.0, .radius_m = 0.5}) ==
        "radius_m is 0.5 without turn_deg: an arc needs both");
  CHECK(refusal({.hold_s = 1.0, .power = 0.5}) ==
        "power is 0.5 beside hold_s: a robot that holds has none");
  options.segments = {{.hold_s = 1.0}};
  options.speed_mps.reset();
  CHECK_THROWS_WITH(Program(options, Metre(), {}), Catch::Contains("none of them moves the robot"));
  options.segments.clear();
  CHECK_THROWS_WITH(Program(options, Metre(), {}), Catch::Contains("program.segments is empty"));
}

TEST_CASE("A program's clock runs while what it asked for is in force, and ends with its rest") {
  ProgramOptions options{.power = 0.5, .laps = 1};
  options.rest_s = 0.5;
  options.segments = {{.straight_m = 0.5}};  // one second
  ProgramController controller(Program(options, Metre(), {}), {});
  double now_s = 10.0;
  const auto step = [&](bool sends) {
    const Decision decision = controller.Step({now_s, 0.25, now_s, {0.0, 0.0, 0.0}});
    controller.NoteSent(now_s, sends ? decision.power : WheelPower{});
    now_s += 0.25;
    return decision;
  };
  CHECK(step(true).v == Approx(0.5));
  CHECK(step(false).v == Approx(0.5));  // held back: a quarter of a second later
  CHECK(step(true).v == Approx(0.5));
  CHECK(step(true).v == Approx(0.5));
  CHECK(step(true).v == Approx(0.5));
  const Decision rests = step(true);
  CHECK(rests.v == 0.0);
  CHECK_FALSE(rests.finished);
  CHECK_FALSE(step(true).finished);
  const Decision ends = step(true);
  CHECK(ends.finished);
  CHECK(ends.reached);
  CHECK(ends.w == 0.0);
}

TEST_CASE("A program's decision tells its target's distance, and power ahead and to the left") {
  ProgramOptions options{.power = 0.5, .laps = 1};
  options.segments = {{.straight_m = 0.5}, {.turn_deg = 90.0, .radius_m = 0.1}};
  ProgramController controller(Program(options, Metre(), {}), {});
  const Decision ahead = controller.Step({10.0, 0.25, 10.0, {0.1, 0.3, 0.0}});
  CHECK(ahead.waypoint == 1);
  CHECK(ahead.distance_m == Approx(0.5));
  CHECK(ahead.v == Approx(0.5));
  CHECK(ahead.w == 0.0);
  CHECK_FALSE(ahead.pose_refused);
  controller.NoteSent(10.0, ahead.power);
  // A pose that is not believed leaves the one before in force, and the clock running.
  const Decision turns = controller.Step({11.0, 0.1, 10.02, {0.1, 900.0, 0.0}});
  CHECK(turns.pose_refused);
  CHECK(turns.waypoint == 2);
  CHECK(turns.distance_m == Approx(std::hypot(0.5, 0.2)));
  CHECK(turns.power.left == Approx(0.0).margin(1e-12));
  CHECK(turns.power.right == Approx(0.5));
  CHECK(turns.v == Approx(0.25));
  CHECK(turns.raw_v == Approx(0.25));
  CHECK(turns.w == Approx(0.25));
  CHECK(turns.raw_w == Approx(0.25));
  // Another power than was asked for stops the clock.
  controller.NoteSent(11.0, {0.1, 0.1});
  CHECK(controller.Step({11.3, 0.1, 10.02, {0.1, 0.3, 0.0}}).power == turns.power);
}

TEST_CASE("A task begins where its program or its first waypoint is, and ideal paths follow both") {
  Task way;
  way.waypoints = {{.name = "s", .x_m = 1.0, .heading_deg = 90.0},
                   {.name = "t", .x_m = 2.0, .y_m = 3.0}};
  CHECK(way.Start() == Pose2{1.0, 0.0, RadFromDeg(90.0)});
  const std::vector<TimedPose> ideal = way.IdealPath();
  REQUIRE(ideal.size() == 2);
  CHECK(ideal[1].captured_s == 1.0);
  CHECK(ideal[1].world_from_robot.x_m == 2.0);
  CHECK(ideal[1].world_from_robot.y_m == 3.0);
  CHECK(std::isnan(ideal[1].world_from_robot.yaw_rad));
  ProgramOptions options{.power = 0.5, .laps = 2};
  options.segments = {{.straight_m = 0.5}};
  const Program program(options, Metre(), {1.0, 2.0, RadFromDeg(90.0)});
  Task task;
  task.program = program;
  CHECK(task.Start() == Pose2{1.0, 2.0, RadFromDeg(90.0)});
  CHECK(task.IdealPath().back().world_from_robot.y_m == Approx(3.0));
  CHECK(task.IdealPath()[1].captured_s == Approx(0.02));
  CHECK(program.waypoints()[0].x_m == 1.0);
  CHECK(program.waypoints()[0].y_m == 2.0);
  CHECK(program.waypoints()[0].heading_deg.value() == Approx(90.0));
}

TEST_CASE(
    "A task's controller is a program's or steers to waypoints, of options that are checked") {
  Task way, task;
  way.waypoints = {{.name = "s"}, {.name = "t", .x_m = 1.0}};
  ProgramOptions options{.power = 0.5, .laps = 1};
  options.segments = {{.straight_m = 0.5}};
  task.program = Program(options, Metre(), {});
  CHECK(dynamic_cast<Navigator*>(MakeController(way, {}).get()) != nullptr);
  CHECK(dynamic_cast<ProgramController*>(MakeController(task, {}).get()) != nullptr);
  NavigatorOptions wrong;
  wrong.v_max = 1.1;
  CHECK_THROWS_AS(MakeController(way, wrong), std::invalid_argument);
  CHECK_THROWS_AS(MakeController(task, wrong), std::invalid_argument);
}

}  // namespace
}  // namespace rift::control
