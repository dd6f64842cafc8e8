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
  const WheelDrive full = motor.Drive(1.0, 0.0, 0.0, 0.004);
  CHECK(Torque(full, 0.0) == Approx(0.33 * 0.0980665));
  CHECK(Torque(full, 720.0 * 2.0 * M_PI / 60.0) == Approx(0.0).margin(1e-12));
  const WheelDrive half = motor.Drive(0.5, 0.0, 0.0, 0.004);
  CHECK(Torque(half, 0.0) == Approx(0.5 * 0.33 * 0.0980665));
}

TEST_CASE("Each gearing has the torque of its data sheet and speed and counts of its ratio") {
  const GearingData standard = DataOf(Gearing::k30To1), slow = DataOf(Gearing::k75To1),
                    fast = DataOf(Gearing::k15To1);
  CHECK(standard.no_load_rad_s == Approx(75.4).epsilon(0.001));
  CHECK(standard.encoder_counts_per_rev == Approx(358.3).margin(0.05));
  CHECK(slow.encoder_counts_per_rev == Approx(909.7).margin(0.05));
  CHECK(fast.no_load_rad_s * 60.0 / (2.0 * M_PI) == Approx(1410.0).margin(5.0));
  CHECK(slow.stall_torque_nm > standard.stall_torque_nm);
  CHECK(fast.stall_torque_nm < standard.stall_torque_nm);
}

TEST_CASE("Powers in the dead band do not drive and those beyond it do in full") {
  MotorOptions options;
  options.dead_band = 0.1;
  Motor motor(options, Side::kLeft);
  CHECK(motor.Drive(0.099, 0.0, 0.0, 0.004).target_rad_s == 0.0);
  CHECK(motor.Drive(-0.101, 0.0, 0.0, 0.004).target_rad_s ==
        Approx(-0.101 * options.NoLoad_rad_s()));
}

TEST_CASE("Friction takes its torque from a driven wheel and holds one that is not") {
  MotorOptions options;
  options.dead_band = 0.0;
  options.friction_torque_nm = 0.002;
  Motor motor(options, Side::kLeft);
  const double stall_nm = 0.33 * 0.0980665;
  CHECK(Torque(motor.Drive(0.5, 10.0, 0.001, 0.004), 0.0) == Approx(0.5 * stall_nm - 0.003));
  CHECK(Torque(motor.Drive(-0.5, -10.0, 0.001, 0.004), 0.0) == Approx(-0.5 * stall_nm + 0.003));
  const WheelDrive held = motor.Drive(0.01, 0.0, 0.001, 0.004);
  CHECK(held.target_rad_s == 0.0);
  CHECK(held.compliance_rad_s_per_nm == 0.0);
  CHECK(held.limit_nm > 0.0);
}

TEST_CASE("A lagging motor follows a step of power exponentially whatever the step") {
  MotorOptions options;
  options.lag_s = 0.05;
  options.dead_band = 0.0;
  for (const double step_s : {0.001, 0.01, 0.05}) {
    Motor motor(options, Side::kLeft);
    double integral = 0.0;
    for (int i = 0; i < std::lround(0.1 / step_s); ++i) {
      integral += step_s * motor.Drive(0.4, 0.0, 0.0, step_s).target_rad_s;
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
  const double left = Motor(options, Side::kLeft).Drive(0.5, 0.0, 0.0, 0.004).target_rad_s;
  const double right = Motor(options, Side::kRight).Drive(0.5, 0.0, 0.0, 0.004).target_rad_s;
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

}  // namespace
}  // namespace rift::simulation
