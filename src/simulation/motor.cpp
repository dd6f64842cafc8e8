#include "rift/simulation/motor.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numbers>

namespace rift::simulation {
namespace {

constexpr double kNmPerKgCm = 0.0980665;
constexpr double kCountsPerMotorRev = 12.0;  // Pololu 0J86/6.4

/// The no-load speed is known for 30:1 alone (720 rpm, Pololu 0J83/5.3); the others follow from the
/// ratio of the gears (75:1: 284 rpm, 15:1: 1410 rpm), which holds for the same motor winding.
GearingData FromGears(double ratio, double stall_kg_cm) {
  constexpr double kMotorRpm = 720.0 * 29.86;
  return {kMotorRpm / ratio * 2.0 * std::numbers::pi / 60.0, stall_kg_cm * kNmPerKgCm,
          kCountsPerMotorRev * ratio};
}

/// Ground drag and friction hold a wheel that the motor cannot turn, and stop one that still rolls.
/// The target is rest and the limit the whole decelerating torque, so no step overshoots it.
WheelDrive Brake(double motor_nm, double rate_rad_s, double drag_nm) {
  const double against_nm = std::copysign(1.0, rate_rad_s) * -motor_nm;
  return {0.0, 0.0, std::max(0.0, drag_nm + against_nm)};
}

}  // namespace

GearingData DataOf(Gearing gearing) {
  switch (gearing) {  // ratios: Pololu 0J86/6.4 and product pages; stall: Pololu 0J83/5.3
    case Gearing::k30To1:
      return FromGears(29.86, 0.33);
    case Gearing::k75To1:
      return FromGears(75.81, 0.64);
    case Gearing::k15To1:
      return FromGears(15.25, 0.25);
  }
  assert(false);
  return {};
}

Motor::Motor(const MotorOptions& options, Side side)
    : options_(options),
      no_load_rad_s_(options.NoLoad_rad_s() *
                     (1.0 + (side == Side::kLeft ? 0.5 : -0.5) * options.mismatch)),
      nm_per_rad_s_(options.StallTorque_nm() / no_load_rad_s_) {}

WheelDrive Motor::Drive(double power, double rate_rad_s, double drag_nm, double step_s) {
  if (options_.model == MotorModel::kServo) {
    return {power * options_.supply_ratio * no_load_rad_s_, 0.0,
            options_.servo_torque_nm.value_or(std::numeric_limits<double>::infinity())};
  }
  const double driven_power = std::abs(power) < options_.dead_band ? 0.0 : power;
  return TorqueLine(MeanThroughLag(driven_power, step_s), rate_rad_s, drag_nm);
}

double Motor::MeanThroughLag(double power, double step_s) {
  if (options_.lag_s == 0.0) return power;
  const double steps = step_s / options_.lag_s;
  const double passed = -std::expm1(-steps);
  const double mean = power + (lagged_power_ - power) * passed / steps;
  lagged_power_ += (power - lagged_power_) * passed;
  return mean;
}

WheelDrive Motor::TorqueLine(double power, double rate_rad_s, double drag_nm) const {
  const double free_rad_s = power * options_.supply_ratio * no_load_rad_s_;
  const double stall_nm = nm_per_rad_s_ * free_rad_s;
  const double friction_nm = options_.friction_torque_nm + drag_nm;
  if (friction_nm > 0.0 && std::abs(stall_nm) <= friction_nm) {
    return Brake(stall_nm - nm_per_rad_s_ * rate_rad_s, rate_rad_s, friction_nm);
  }
  // A wheel still turning the other way is slowed by friction, hence helped along.
  const bool reversing = rate_rad_s * free_rad_s < 0.0;
  const double opposing_nm = std::copysign(friction_nm, reversing ? -free_rad_s : free_rad_s);
  return {free_rad_s - opposing_nm / nm_per_rad_s_, 1.0 / nm_per_rad_s_,
          std::numeric_limits<double>::infinity()};
}

std::int64_t CountsAt(double angle_rad, double counts_per_rev) {
  return static_cast<std::int64_t>(
      std::floor(angle_rad * counts_per_rev / (2.0 * std::numbers::pi)));
}

}  // namespace rift::simulation
