#include "rift/simulation/motor.hpp"

#include <catch2/catch.hpp>
#include <cmath>

namespace rift::simulation {
namespace {

double Torque(const WheelDrive& drive, double rate_rad_s) {
  return (drive.target_rad_s - rate_rad_s) / drive.compliance_rad_s_per_nm;
}

TEST_CASE("The torque line passes through stall and no load speed") {
  const MotorOptions options;
  Motor motor(options, Side::kLeft);
  const WheelDrive full = motor.Drive(StepPower::Constant(1.0), 0.0, 0.0, 0.004);
  CHECK(Torque(full, 0.0) == Approx(0.33 * 0.0980665));
  CHECK(Torque(full, 720.0 * 2.0 * M_PI / 60.0) == Approx(0.0).margin(1e-12));
  const WheelDrive half = motor.Drive(StepPower::Constant(0.5), 0.0, 0.0, 0.004);
  CHECK(Torque(half, 0.0) == Approx(0.5 * 0.33 * 0.0980665));
}

TEST_CASE("Each gearing has speed and torque of its data sheet and the counts of its ratio") {
  const GearingData standard = DataOf(Gearing::k30To1), slow = DataOf(Gearing::k75To1),
                    fast = DataOf(Gearing::k15To1);
  CHECK(standard.no_load_rad_s == Approx(75.4).epsilon(0.001));
  CHECK(standard.encoder_counts_per_rev == Approx(358.3).margin(0.05));
  CHECK(slow.encoder_counts_per_rev == Approx(909.7).margin(0.05));
  CHECK(fast.encoder_counts_per_rev == Approx(183.0).margin(0.05));
  const auto rpm = [](const GearingData& data) { return data.no_load_rad_s * 30.0 / M_PI; };
  CHECK(rpm(standard) == Approx(720.0));  // Pololu 0J83/5.3
  CHECK(rpm(slow) == Approx(180.0));
  CHECK(rpm(fast) == Approx(2100.0));
  CHECK(standard.stall_torque_nm == Approx(0.33 * 0.0980665));
  CHECK(slow.stall_torque_nm == Approx(0.64 * 0.0980665));
  CHECK(fast.stall_torque_nm == Approx(0.25 * 0.0980665));
}

TEST_CASE("Powers in the dead band do not drive and those beyond it do in full") {
  MotorOptions options;
  options.dead_band = 0.1;
  Motor motor(options, Side::kLeft);
  CHECK(motor.Drive(StepPower::Constant(0.099), 0.0, 0.0, 0.004).target_rad_s == 0.0);
  CHECK(motor.Drive(StepPower::Constant(-0.101), 0.0, 0.0, 0.004).target_rad_s ==
        Approx(-0.101 * options.NoLoad_rad_s()));
}

TEST_CASE("Friction takes its torque from a driven wheel and brakes one that is not") {
  MotorOptions options;
  options.dead_band = 0.0;
  options.friction_torque_nm = 0.002;
  Motor motor(options, Side::kLeft);
  const double stall_nm = 0.33 * 0.0980665, sign = GENERATE(-1.0, 1.0);
  const WheelDrive driven = motor.Drive(StepPower::Constant(sign * 0.5), sign * 10.0, 0.001, 0.004);
  CHECK(Torque(driven, 0.0) == Approx(sign * (0.5 * stall_nm - 0.003)));
  CHECK(driven.friction_nm == 0.0);
  // Towards rest friction stands by itself: the line alone would turn the wheel back.
  const WheelDrive braked = motor.Drive(StepPower::Constant(0.0), sign * 10.0, 0.001, 0.004);
  CHECK(sign * Torque(braked, sign * 10.0) < 0.0);
  CHECK(Torque(braked, 0.0) == Approx(0.0).margin(1e-12));
  CHECK(braked.friction_nm == Approx(0.003));
  CHECK(motor.Drive(StepPower::Constant(sign * 0.5), -sign * 10.0, 0.001, 0.004).friction_nm ==
        Approx(0.003));
}

TEST_CASE("A wheel at rest breaks away beyond its static friction, in either direction") {
  MotorOptions options;
  options.dead_band = 0.0;
  options.friction_torque_nm = 0.002;
  options.breakaway_torque_nm = 0.004;
  Motor motor(options, Side::kRight);
  const double stall_nm = 0.33 * 0.0980665, sign = GENERATE(-1.0, 1.0);
  const double held_power = sign * 0.0039 / stall_nm, moving_power = sign * 0.0041 / stall_nm;
  CHECK(motor.Drive(StepPower::Constant(held_power), 0.0, 0.0005, 0.004).friction_nm ==
        Approx(0.0045));
  CHECK(
      motor.Drive(StepPower::Constant(sign * 0.0044 / stall_nm), 0.0, 0.0005, 0.004).friction_nm ==
      Approx(0.0045));
  CHECK(motor.Drive(StepPower::Constant(moving_power), 0.0, 0.0, 0.004).friction_nm ==
        Approx(0.002));
  // Once it turns, running friction is all there is.
  CHECK(Torque(motor.Drive(StepPower::Constant(held_power), sign * 1.0, 0.0, 0.004), 0.0) ==
        Approx(sign * 0.0019));
}

TEST_CASE(
    "Friction falls smoothly from that at rest to that of a turning wheel where it is asked to") {
  MotorOptions options;
  options.dead_band = 0.0;
  options.friction_torque_nm = 0.002;
  options.breakaway_torque_nm = 0.004;
  options.friction_fall_rad_s = 5.0;
  Motor motor(options, Side::kLeft);
  const double stall_nm = 0.33 * 0.0980665, sign = GENERATE(-1.0, 1.0);
  const auto friction_nm = [&](double rate_rad_s) {
    const WheelDrive driven =
        motor.Drive(StepPower::Constant(sign * 0.5), sign * rate_rad_s, 0.0, 0.004);
    CHECK(driven.friction_nm == 0.0);
    return 0.5 * stall_nm - sign * Torque(driven, 0.0);
  };
  CHECK(friction_nm(0.01) == Approx(0.004).epsilon(1e-4));
  CHECK(friction_nm(5.0) == Approx(0.002 + 0.002 / M_E));
  CHECK(friction_nm(10.0) == Approx(0.002 + 0.002 * std::exp(-4.0)));
  CHECK(friction_nm(30.0) == Approx(0.002));
  // A wheel that slows down without power meets the same friction, and so does one at rest.
  CHECK(motor.Drive(StepPower::Constant(0.0), sign * 5.0, 0.001, 0.004).friction_nm ==
        Approx(0.003 + 0.002 / M_E));
  CHECK(motor.Drive(StepPower::Constant(sign * 0.0041 / stall_nm), 0.0, 0.0, 0.004).friction_nm ==
        Approx(0.004));
}

TEST_CASE("Static friction below the running one is refused") {
  MotorOptions options;
  options.friction_torque_nm = 0.002;
  options.breakaway_torque_nm = 0.001;
  CHECK_THROWS_WITH(options.Check(), Catch::Contains("breakaway_torque_nm is 0.001"));
}

TEST_CASE("A lagging motor follows a step of power exponentially whatever the step") {
  MotorOptions options;
  options.lag_s = 0.05;
  options.dead_band = 0.0;
  for (const double step_s : {0.001, 0.01, 0.05}) {
    Motor motor(options, Side::kLeft);
    double integral = 0.0;
    for (int i = 0; i < std::lround(0.1 / step_s); ++i) {
      integral += step_s * motor.Drive(StepPower::Constant(0.4), 0.0, 0.0, step_s).target_rad_s;
    }
    const double expected =
        0.4 * options.NoLoad_rad_s() * (0.1 - 0.05 * (1.0 - std::exp(-0.1 / 0.05)));
    CHECK(integral == Approx(expected));
  }
}

TEST_CASE("Mismatch parts the wheels by its share and keeps their mean") {
  MotorOptions options;
  options.mismatch = 0.04;
  options.model = GENERATE(MotorModel::kDc, MotorModel::kServo);
  const double left =
      Motor(options, Side::kLeft).Drive(StepPower::Constant(0.5), 0.0, 0.0, 0.004).target_rad_s;
  const double right =
      Motor(options, Side::kRight).Drive(StepPower::Constant(0.5), 0.0, 0.0, 0.004).target_rad_s;
  CHECK(0.5 * (left + right) == Approx(0.5 * options.NoLoad_rad_s()));
  CHECK((left - right) / (0.5 * (left + right)) == Approx(0.04));
}

TEST_CASE("Encoders count whole edges in both directions") {
  const double edge_rad = 2.0 * M_PI / 358.3;
  CHECK(CountsAt(0.0, 358.3) == 0);
  CHECK(CountsAt(0.99 * edge_rad, 358.3) == 0);
  CHECK(CountsAt(1.01 * edge_rad, 358.3) == 1);
  CHECK(CountsAt(-0.01 * edge_rad, 358.3) == -1);
  CHECK(CountsAt(2.0 * M_PI * 100.0 + 1e-9, 358.3) == 35830);
}

/// Mean friction over a step in which the power rises in a straight line, by adding up: the wheel
/// is held by what the motor asks for until that breaks it away.
double MeanFriction_nm(double before_nm, double after_nm, double breakaway_nm, double running_nm) {
  constexpr int kParts = 100'000;
  double sum = 0.0;
  for (int i = 0; i < kParts; ++i) {
    const double asked_nm = before_nm + (after_nm - before_nm) * (i + 0.5) / kParts;
    sum += asked_nm < breakaway_nm ? std::abs(asked_nm) : running_nm;
  }
  return sum / kParts;
}

TEST_CASE("A wheel that a lagging motor breaks away within a step has the mean friction of it") {
  MotorOptions options;
  options.dead_band = 0.0;
  options.lag_s = 1.0;  // over 0.01 s nearly a straight line
  options.friction_torque_nm = 0.0001;
  options.breakaway_torque_nm = 0.0006;
  options.supply_ratio = 1.25;
  const double stall_nm = 1.25 * options.StallTorque_nm(), sign = GENERATE(1.0, -1.0);
  Motor motor(options, Side::kLeft);
  const auto friction_nm = [&] {
    return motor.Drive(StepPower::Constant(sign * 1.0), 0.0, 0.00002, 0.01).friction_nm;
  };
  double before_nm = 0.0;
  for (int step = 1; step <= 3; ++step) {
    INFO("step " << step);
    const double after_nm = stall_nm * -std::expm1(-0.01 * step);
    // It breaks away in the second step; until then friction stands against all that is asked.
    CHECK(friction_nm() ==
          Approx(step == 1 ? 0.00062 : MeanFriction_nm(before_nm, after_nm, 0.00062, 0.00012))
              .epsilon(0.002));
    before_nm = after_nm;
  }
}

TEST_CASE("A wheel is held until the moment in the step at which its power changes") {
  MotorOptions options;
  options.dead_band = 0.1;
  options.friction_torque_nm = 0.002;
  options.breakaway_torque_nm = 0.004;
  const double sign = GENERATE(1.0, -1.0), stall_nm = options.StallTorque_nm();
  Motor motor(options, Side::kRight);
  const auto at = [&](double before, double mean, double after) {
    return motor.Drive({sign * before, sign * mean, sign * after}, 0.0, 0.0, 0.004);
  };
  // A quarter of the step at rest, then three quarters at half the power.
  const WheelDrive from_rest = at(0.0, 0.375, 0.5);
  CHECK(from_rest.friction_nm == Approx(0.75 * 0.002));
  CHECK(from_rest.target_rad_s == Approx(sign * 0.375 * options.NoLoad_rad_s()));
  // 0.12 of the power turns nothing yet, but is what friction then stands against.
  CHECK(at(0.12, 0.31, 0.5).friction_nm == Approx(0.5 * 0.002 + 0.5 * 0.12 * stall_nm));
  // Within the dead band is nothing: then 3/4 of the way from 0.05 to 0.45 is 3/4 of 0.45.
  const WheelDrive from_dead = at(0.05, 0.35, 0.45);
  CHECK(from_dead.target_rad_s == Approx(sign * 0.75 * 0.45 * options.NoLoad_rad_s()));
  CHECK(from_dead.friction_nm == Approx(0.75 * 0.002));
  CHECK(at(0.5, 0.25, 0.0).friction_nm == Approx(0.004));
}

TEST_CASE("Voltage scales speed and torque, and a servo has the torque it is given") {
  MotorOptions options;
  options.supply_ratio = 0.8;
  options.no_load_rad_s = 50.0;
  options.stall_torque_nm = 0.04;
  Motor motor(options, Side::kLeft);
  const WheelDrive drive = motor.Drive(StepPower::Constant(0.5), 1e-5, 0.0, 0.004);
  CHECK(drive.target_rad_s == Approx(0.5 * 0.8 * 50.0));
  CHECK(Torque(drive, 0.0) == Approx(0.5 * 0.8 * 0.04));
  CHECK(std::isinf(drive.limit_nm));
  options.model = MotorModel::kServo;
  options.dead_band = 0.9;  // of the brushed motor alone
  options.friction_torque_nm = 1.0;
  WheelDrive servo = Motor(options, Side::kLeft).Drive({0.1, 0.3, 0.5}, 5.0, 2.0, 0.004);
  CHECK(servo.target_rad_s == Approx(0.3 * 0.8 * 50.0));
  CHECK((servo.compliance_rad_s_per_nm == 0.0 && servo.friction_nm == 0.0));
  CHECK(std::isinf(servo.limit_nm));
  options.servo_torque_nm = 0.7;
  servo = Motor(options, Side::kLeft).Drive(StepPower::Constant(0.3), 0.0, 0.0, 0.004);
  CHECK(servo.limit_nm == 0.7);
}

TEST_CASE("A wheel is at rest below a millionth of a radian a second") {
  MotorOptions options;
  options.friction_torque_nm = 0.001;
  options.breakaway_torque_nm = 0.003;
  CHECK_NOTHROW(options.Check());
  Motor motor(options, Side::kLeft);
  const auto friction_nm = [&](double rate_rad_s) {
    return motor.Drive(StepPower::Constant(0.0), rate_rad_s, 0.0005, 0.004).friction_nm;
  };
  CHECK(friction_nm(0.9e-6) == Approx(0.0035));
  CHECK(friction_nm(-0.9e-6) == Approx(0.0035));
  CHECK(friction_nm(1.1e-6) == Approx(0.0015));
  CHECK(friction_nm(-1.1e-6) == Approx(0.0015));
  options.breakaway_torque_nm = options.friction_torque_nm;
  CHECK_NOTHROW(options.Check());
  options.breakaway_torque_nm = 0.0009;
  CHECK_THROWS_WITH(options.Check(),
                    "breakaway_torque_nm is 0.0009, but it must be at least friction_torque_nm, "
                    "0.001");
}

TEST_CASE("The power at which the dead band ends turns the wheel, forwards and backwards") {
  MotorOptions options;
  options.dead_band = 0.125;
  options.no_load_rad_s = 80.0;
  Motor motor(options, Side::kLeft);
  for (const double sign : {1.0, -1.0}) {
    CHECK(motor.Drive(StepPower::Constant(sign * 0.125), 0.0, 0.0, 0.004).target_rad_s ==
          Approx(sign * 10.0));
    CHECK(motor.Drive(StepPower::Constant(sign * 0.12499), 0.0, 0.0, 0.004).target_rad_s == 0.0);
  }
}

TEST_CASE("Wheels that differ in speed push equally at standstill") {
  MotorOptions options;
  options.mismatch = 0.2;
  options.no_load_rad_s = 50.0;
  options.stall_torque_nm = 0.04;
  for (const Side side : {Side::kLeft, Side::kRight}) {
    const WheelDrive drive = Motor(options, side).Drive(StepPower::Constant(0.5), 1e-5, 0.0, 0.004);
    CHECK(drive.target_rad_s == Approx(side == Side::kLeft ? 27.5 : 22.5));
    CHECK(Torque(drive, 0.0) == Approx(0.02));
  }
}

TEST_CASE("A lagging motor starts at once beyond its dead band, and a servo does not lag") {
  MotorOptions options;
  options.dead_band = 0.1;
  options.lag_s = 0.05;
  options.no_load_rad_s = 100.0;
  // Mean of 1 - exp(-t / 0.05) over the first 0.005 s, of half the speed.
  const double mean = 1.0 - (1.0 - std::exp(-0.1)) / 0.1;
  const auto first_rad_s = [&] {
    Motor motor(options, Side::kRight);
    return motor.Drive(StepPower::Constant(-0.5), 0.0, 0.0, 0.005).target_rad_s;
  };
  CHECK(first_rad_s() == Approx(-50.0 * mean));
  options.model = MotorModel::kServo;
  CHECK(first_rad_s() == Approx(-50.0));
}

}  // namespace
}  // namespace rift::simulation
