#include "rift/simulation/simulated_robot.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <utility>
#include <vector>

#include "rift/geometry/pose2.hpp"
#include "support/mirror.hpp"

namespace rift::simulation {
namespace {

SimulationOptions Ideal() {
  SimulationOptions options;
  options.motor.model = MotorModel::kServo;
  options.link = {.delay_s = 0.0, .baud = 0.0, .poll_s = 0.0, .two_decimals = false};
  options.mocap = {.rate_hz = 0.0,
                   .noise_across_m = 0.0,
                   .blur_across_s = 0.0,
                   .noise_along_m = 0.0,
                   .stamp_jitter_s = 0.0,
                   .noise_yaw_rad = 0.0,
                   .blur_yaw_rad_per_mps = 0.0,
                   .noise_z_m = 0.0,
                   .noise_tilt_rad = 0.0};
  return options;
}

control::WheelPower Weave(int control_step) {
  const double turn = 0.03 * std::sin(0.1 * control_step);
  return {0.18 - turn, 0.18 + turn};
}

std::vector<double> Drive(const SimulationOptions& options, std::uint64_t seed) {
  SimulatedRobot robot(options, {-0.28, -0.06, -0.02}, seed);
  std::vector<double> log;
  for (int i = 0; i < 150; ++i) {
    robot.Command(Weave(i));
    robot.Advance(0.02);
    const trial::Sensed sensed = robot.Sense();
    log.insert(log.end(), {robot.Truth().x_m, robot.Truth().y_m, robot.Truth().yaw_rad});
    if (!sensed.pose) continue;
    log.insert(log.end(), {sensed.pose->captured_s, sensed.pose->world_from_robot.x_m,
                           sensed.pose->world_from_robot.yaw_rad});
  }
  return log;
}

TEST_CASE("The same seed gives the same bytes even after other runs") {
  const std::vector<double> first = Drive(SimulationOptions{}, 5);
  Drive(Ideal(), 1);
  const std::vector<double> other = Drive(SimulationOptions{}, 6);
  CHECK(Drive(SimulationOptions{}, 5) == first);
  CHECK(other != first);
}

TEST_CASE("How the time is cut into calls does not change the motion") {
  SimulatedRobot coarse(SimulationOptions{}, {}, 3), fine(SimulationOptions{}, {}, 3);
  coarse.Command({0.2, 0.15});
  fine.Command({0.2, 0.15});
  coarse.Advance(1.0);
  for (int i = 0; i < 1000; ++i) fine.Advance(0.001);
  CHECK(coarse.Truth().x_m == fine.Truth().x_m);
  CHECK(coarse.Truth().t_s == fine.Truth().t_s);
  CHECK(coarse.Sense().now_s == fine.Sense().now_s);
}

TEST_CASE("The clock does not drift when the step does not divide the control interval") {
  SimulationOptions options = Ideal();
  options.step_s = 0.007;
  SimulatedRobot robot(options, {}, 1);
  for (int i = 0; i < 500; ++i) robot.Advance(0.02);
  CHECK(robot.Sense().now_s == Approx(10.0).margin(1e-12));
  CHECK(robot.Truth().t_s <= 10.0);
  CHECK(robot.Truth().t_s > 10.0 - 0.007);
}

TEST_CASE("The true pose leans with the ramp, up, down and across") {
  SimulationOptions options = Ideal();
  options.terrain.surface = "downhill";
  const double slope_rad = 0.255;
  // Pitch is positive with the nose down, roll with the right side down (x forward, y left, z up).
  const auto leans = [&](double yaw_rad, double roll_rad, double pitch_rad) {
    SimulatedRobot robot(options, {0.45, 0.0, yaw_rad}, 1);
    robot.Advance(0.1);
    CHECK(robot.Truth().roll_rad == Approx(roll_rad).margin(0.01));
    CHECK(robot.Truth().pitch_rad == Approx(pitch_rad).margin(0.01));
    CHECK(robot.Truth().yaw_rad == Approx(yaw_rad).margin(0.01));
  };
  leans(0.0, 0.0, slope_rad);
  leans(3.13, 0.0, -slope_rad);
  leans(1.5707963, slope_rad, 0.0);
  leans(-1.5707963, -slope_rad, 0.0);
}

TEST_CASE("Without link delay a power drives the wheel at its share of the full speed") {
  SimulatedRobot robot(Ideal(), {}, 1);
  robot.Command({0.2, 0.2});
  robot.Advance(2.0);
  CHECK(robot.State().wheel_rate_rad_s[0] == Approx(0.2 * 75.4).epsilon(0.001));
  CHECK(robot.State().velocity_mps.x() == Approx(0.2 * 1.206).epsilon(0.005));
}

TEST_CASE("A brushed motor settles where its torque meets friction and rolling resistance") {
  SimulationOptions options = Ideal();
  options.motor.model = MotorModel::kDc;
  options.motor.friction_torque_nm = 0.001;
  options.terrain.surfaces["ground"].rolling_resistance = 0.02;
  options.terrain.surfaces["ground"].slip = 0.0;
  SimulatedRobot robot(options, {}, 1);
  robot.Command({0.2, 0.2});
  robot.Advance(3.0);
  const double drag_nm = 0.001 + 0.02 * options.body.WeightOnWheel_n() * 0.016;
  const double stall_nm = options.motor.StallTorque_nm();
  const double expected_rad_s = (0.2 - drag_nm / stall_nm) * options.motor.NoLoad_rad_s();
  CHECK(robot.State().wheel_rate_rad_s[0] == Approx(expected_rad_s).epsilon(0.001));
}

TEST_CASE("Each motor has the rolling resistance of what is under its own wheel") {
  test::OnBothSides("left", "right", [](const test::Side& side) {
    SimulationOptions options = Ideal();
    options.motor.model = MotorModel::kDc;
    options.terrain.surfaces["ground"].rolling_resistance = 0.0;
    options.terrain.surfaces["ground"].slip = 0.0;
    PatchOptions patch{.x_min_m = -1.0, .x_max_m = 1.0, .mu = 0.8, .rolling_resistance = 0.02};
    patch.y_min_m = side.IsFirst() ? 0.02 : -0.1;
    patch.y_max_m = side.IsFirst() ? 0.1 : -0.02;
    options.terrain.patches = {patch};
    SimulatedRobot robot(options, {}, 1);
    robot.Command({0.2, 0.2});
    robot.Advance(0.6);  // twelve time constants
    const double free_rad_s = 0.2 * options.motor.NoLoad_rad_s();
    const double drag_nm = 0.02 * options.body.WeightOnWheel_n() * 0.016;
    const double slower_rad_s =
        drag_nm / options.motor.StallTorque_nm() * options.motor.NoLoad_rad_s();
    const auto& rate_rad_s = robot.State().wheel_rate_rad_s;
    CHECK(rate_rad_s[side.IsFirst() ? 0 : 1] ==
          Approx(free_rad_s - slower_rad_s).margin(0.1 * slower_rad_s));
    CHECK(rate_rad_s[side.IsFirst() ? 1 : 0] == Approx(free_rad_s).margin(0.1 * slower_rad_s));
  });
}

TEST_CASE("A camera without a rate shows where the robot stands before it was ever advanced") {
  const geometry::Pose2 start{0.1, -0.2, 0.7};
  const trial::Sensed sensed = SimulatedRobot(Ideal(), start, 1).Sense();
  REQUIRE(sensed.pose);
  CHECK(sensed.pose->captured_s == 0.0);
  CHECK(sensed.pose->world_from_robot.x_m == Approx(0.1));
  CHECK(sensed.pose->world_from_robot.y_m == Approx(-0.2));
  CHECK(sensed.pose->world_from_robot.yaw_rad == Approx(0.7));
}

TEST_CASE("A brushed robot speeds up with the time constant of its mass and torque line") {
  SimulationOptions options = Ideal();
  options.motor.model = MotorModel::kDc;
  options.terrain.surfaces["ground"] = SurfaceOptions{};
  options.terrain.surfaces["ground"].mu = 5.0;
  options.step_s = GENERATE(0.001, 0.004, 0.008);
  const BodyOptions& body = options.body;
  const double inertia = (body.chassis_mass_kg + 3.0 * body.wheel_mass_kg) * body.wheel_radius_m *
                         body.wheel_radius_m / 2.0;
  const double constant_s = inertia * options.motor.NoLoad_rad_s() / options.motor.StallTorque_nm();
  SimulatedRobot robot(options, {}, 1);
  robot.Command({0.2, 0.2});
  const double time_s = 0.16;
  robot.Advance(time_s);
  const double expected_mps =
      0.2 * options.motor.NoLoad_rad_s() * 0.016 * -std::expm1(-time_s / constant_s);
  CHECK(robot.State().velocity_mps.x() == Approx(expected_mps).epsilon(0.03));
}

TEST_CASE("A steep torque line does not oscillate at long steps") {
  SimulationOptions options = Ideal();
  options.motor.model = MotorModel::kDc;
  options.motor.stall_torque_nm = 1.0;
  options.motor.friction_torque_nm = 0.002;
  options.step_s = 0.008;
  SimulatedRobot robot(options, {}, 1);
  robot.Command({0.2, 0.2});
  robot.Advance(1.0);
  const double steady_rad_s = robot.State().wheel_rate_rad_s[0];
  for (int i = 0; i < 20; ++i) {
    robot.Advance(0.008);
    CHECK(robot.State().wheel_rate_rad_s[0] == Approx(steady_rad_s).margin(1e-3));
  }
  robot.Command({0.0, 0.0});
  robot.Advance(1.0);
  CHECK(std::abs(robot.State().wheel_rate_rad_s[0]) < 1e-6);
  CHECK(std::abs(robot.State().velocity_mps.x()) < 1e-5);
}

TEST_CASE("Encoders count what the wheels turned") {
  SimulatedRobot robot(Ideal(), {}, 1);
  robot.Command({-0.1, 0.2});
  robot.Advance(1.0);
  const control::EncoderCounts counts = robot.Sense().encoders.value();
  const auto& angle_rad = robot.State().wheel_angle_rad;
  CHECK(counts.left == std::lround(std::floor(angle_rad[0] * 358.32 / (2.0 * geometry::kPi))));
  CHECK(counts.right == std::lround(std::floor(angle_rad[1] * 358.32 / (2.0 * geometry::kPi))));
  CHECK(counts.left < -400);
}

TEST_CASE("A strong servo with a stepped command slips on parchment and less when ramped") {
  SimulationOptions options = Ideal();
  options.terrain.surface = "parchment";
  options.step_s = 0.032;
  options.sampling = Sampling::kStepped;
  SimulatedRobot robot(options, {}, 1);
  robot.Command({0.2, 0.2});
  robot.Advance(0.032);
  CHECK(robot.State().wheel_rate_rad_s[0] == Approx(0.2 * 75.4).epsilon(0.02));
  CHECK(robot.State().velocity_mps.x() < 0.7 * 0.2 * 1.206);
  robot.Advance(1.0);
  CHECK(robot.State().velocity_mps.x() == Approx(0.2 * 1.206).epsilon(0.02));
}

TEST_CASE("A power that is no number or out of range is refused") {
  SimulatedRobot robot(Ideal(), {}, 1);
  CHECK_THROWS_WITH(robot.Command({std::nan(""), 0.0}), Catch::Contains("left power"));
  CHECK_THROWS_WITH(robot.Command({0.0, 1.2}), Catch::Contains("right power is 1.2"));
  CHECK_THROWS_WITH(robot.Advance(-1.0), Catch::Contains("-1"));
}

TEST_CASE("Options out of range are refused by name") {
  SimulationOptions options;
  options.body.chassis_mass_kg = 0.0;
  CHECK_THROWS_WITH(SimulatedRobot(options, {}, 1), Catch::Contains("body.chassis_mass_kg is 0"));
  options = {};
  options.step_s = std::nan("");
  CHECK_THROWS_WITH(SimulatedRobot(options, {}, 1), Catch::Contains("step_s is nan"));
  options = {};
  options.terrain.surfaces["ground"].mu = -0.1;
  CHECK_THROWS_WITH(SimulatedRobot(options, {}, 1),
                    Catch::Contains("terrain.surfaces.ground.mu is -0.1"));
  options = {};
  options.terrain.surface = "moss";
  CHECK_THROWS_WITH(SimulatedRobot(options, {}, 1), Catch::Contains("'moss'"));
}

TEST_CASE("Full power in both directions at the longest step never leaves the finite") {
  SimulationOptions options = Ideal();
  options.step_s = 0.05;
  options.motor.servo_torque_nm = 100.0;
  options.terrain.surface = GENERATE("ground", "bump", "downhill");
  SimulatedRobot robot(options, {}, 1);
  for (int i = 0; i < 100; ++i) {
    robot.Command(i % 2 ? control::WheelPower{1.0, -1.0} : control::WheelPower{-1.0, 1.0});
    robot.Advance(0.05);
    const trial::Sensed sensed = robot.Sense();
    if (sensed.fault) break;
    REQUIRE(robot.Truth().Planar().IsFinite());
  }
}

TEST_CASE("A servo with a torque limit accelerates as its torque and the robot's mass allow") {
  SimulationOptions options = Ideal();
  options.terrain.surfaces["ground"].slip = 0.0;
  options.motor.servo_torque_nm = 0.002;
  SimulatedRobot robot(options, {}, 1);
  robot.Command({0.4, 0.4});
  robot.Advance(0.2);
  // A wheel is a cylinder: rolling, it weighs 1.5 of its mass.
  const BodyOptions& body = options.body;
  const double acceleration_mps2 =
      2.0 * 0.002 / body.wheel_radius_m / (body.chassis_mass_kg + 2.0 * 1.5 * body.wheel_mass_kg);
  CHECK(robot.State().velocity_mps.x() == Approx(0.2 * acceleration_mps2).epsilon(0.03));
  robot.Advance(1.0);
  CHECK(robot.State().velocity_mps.x() == Approx(0.4 * 75.4 * 0.016).epsilon(0.01));
  options.motor.servo_torque_nm.reset();
  SimulatedRobot strong(options, {}, 1);
  strong.Command({0.4, 0.4});
  strong.Advance(0.2);
  CHECK(strong.State().velocity_mps.x() == Approx(0.4 * 75.4 * 0.016).epsilon(0.01));
}

TEST_CASE("A robot whose caster ball is too high is told the height that makes it level") {
  BodyOptions body;
  CHECK_FALSE(TiltWarning(body));
  // 2.25 mm over 40.4 mm to the caster.
  body.caster_below_m = 0.0074;
  const auto warning = TiltWarning(body);
  REQUIRE(warning);
  INFO(*warning);
  CHECK_THAT(*warning, Catch::Contains("tilted by 3.2 deg, nose up") &&
                           Catch::Contains("0.0023 m above the floor") &&
                           Catch::Contains("simulation.body.caster_below_m is 0.0074") &&
                           Catch::Contains("and 0.00965 "));
  body.caster_below_m = 0.00965;
  CHECK_FALSE(TiltWarning(body));
  body.caster_below_m = 0.0119;
  CHECK_THAT(*TiltWarning(body),
             Catch::Contains("nose down") && Catch::Contains("below the floor"));
}

TEST_CASE("Stopping brings the robot to rest and may be repeated") {
  SimulatedRobot robot(SimulationOptions{}, {}, 1);
  for (int i = 0; i < 50; ++i) {
    robot.Command({0.2, 0.2});
    robot.Advance(0.02);
  }
  CHECK(robot.State().velocity_mps.norm() > 0.1);
  robot.Stop();
  robot.Stop();
  robot.Advance(1.0);
  CHECK(robot.State().velocity_mps.norm() < 1e-4);
}

TEST_CASE("What a robot is told wrong is refused with its path, its value and its range") {
  const auto refusal = [](const std::function<void(SimulationOptions&)>& change,
                          const geometry::Pose2& start = {}) -> std::string {
    SimulationOptions options;
    change(options);
    try {
      SimulatedRobot(options, start, 1);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "accepted";
  };
  CHECK(refusal([](auto& o) { o.step_s = 0.0501; }) ==
        "step_s is 0.0501, but it must lie in [0.0001, 0.05]");
  CHECK(refusal([](auto& o) { o.step_s = 0.05; }) == "accepted");
  CHECK(refusal([](auto& o) { o.step_s = 0.00009; }) ==
        "step_s is 9e-05, but it must lie in [0.0001, 0.05]");
  CHECK(refusal([](auto& o) { o.motor.servo_torque_nm = 0.0; }) ==
        "motor.servo_torque_nm is 0, but it must lie in [0.001, 100]");
  CHECK(refusal([](auto& o) { o.link.uart_bytes = -1; }) ==
        "link.uart_bytes is -1, but it must lie in [0, 1e+06]");
  CHECK(refusal([](auto& o) {
          o.terrain.patches.resize(2);
          o.terrain.patches[1].mu = 6.0;
        }) == "terrain.patches[1].mu is 6, but it must lie in [0, 5]");
  CHECK(refusal([](auto& o) {
          o.terrain.patches.resize(1);
          o.terrain.patches[0].x_max_m = -1.0;
        }) == "x_min_m is 0, but it must lie below x_max_m, -1");
  CHECK(refusal([](auto& o) {
          o.motor.breakaway_torque_nm = 0.0, o.motor.friction_torque_nm = 0.1;
        }) == "breakaway_torque_nm is 0, but it must be at least friction_torque_nm, 0.1");
  CHECK(refusal([](auto&) {}, {1.0, std::nan(""), 2.0}) ==
        "the start pose is (1, nan, 2), but it must be finite");
}

TEST_CASE(
    "A power may be as much beyond one as a sum rounds, and a time from none to a million "
    "seconds") {
  SimulatedRobot robot(Ideal(), {}, 1);
  CHECK_NOTHROW(robot.Command({1.0 + 0.9e-9, -1.0 - 0.9e-9}));
  CHECK_THROWS_WITH(robot.Command({0.0, -1.1}),
                    "the right power is -1.1, but it must lie in [-1, 1]");
  CHECK_THROWS(robot.Command({1.0 + 2e-9, 0.0}));
  CHECK_NOTHROW(robot.Advance(0.0));
  CHECK_THROWS_WITH(robot.Advance(1e6 + 1.0),
                    "the robot cannot advance by 1000001 s, only by 0 to 1000000 s");
  CHECK_THROWS(robot.Advance(std::nan("")));
  CHECK(robot.Sense().now_s == 0.0);
}

TEST_CASE("Encoders are reported unless they are not, in counts of their own or of the gearing") {
  SimulationOptions options = Ideal();
  options.encoder.reported = false;
  CHECK_FALSE(SimulatedRobot(options, {}, 1).Sense().encoders);
  const auto counts = [&] {
    SimulatedRobot robot(options, {}, 1);
    robot.Command({0.1, 0.2});
    robot.Advance(1.0);
    return std::pair(*robot.Sense().encoders, robot.State().wheel_angle_rad);
  };
  options.encoder = {.reported = true, .counts_per_rev = 1000.0};
  auto [own, angle_rad] = counts();
  CHECK(own.left == std::lround(std::floor(angle_rad[0] * 1000.0 / (2.0 * geometry::kPi))));
  CHECK(own.right == std::lround(std::floor(angle_rad[1] * 1000.0 / (2.0 * geometry::kPi))));
  options.encoder = {};
  options.motor.gearing = Gearing::k75To1;
  auto [geared, geared_rad] = counts();
  CHECK(geared.right ==
        std::lround(std::floor(geared_rad[1] * 12.0 * 75.81 / (2.0 * geometry::kPi))));
}

TEST_CASE("A brushed motor whose power comes within a long step starts when it comes") {
  test::OnBothSides("left", "right", [](const test::Side& side) {
    SimulationOptions options = Ideal();
    options.motor.model = MotorModel::kDc;
    options.motor.friction_torque_nm = 0.001;
    options.motor.breakaway_torque_nm = 0.003;
    options.link.delay_s = 0.03;
    const auto rolled_rad = [&](double step_s) {
      options.step_s = step_s;
      SimulatedRobot robot(options, {}, 1);
      robot.Command(side.Of<control::WheelPower>(0.4, 0.0));
      robot.Advance(0.2);
      return robot.State().wheel_angle_rad[side.IsFirst() ? 0 : 1];
    };
    const double fine_rad = rolled_rad(0.0005);
    CHECK(fine_rad > 1.0);
    // A step that stands still until its end is a tenth of the way behind.
    CHECK(rolled_rad(0.04) == Approx(fine_rad).epsilon(0.05));
  });
}

}  // namespace
}  // namespace rift::simulation
