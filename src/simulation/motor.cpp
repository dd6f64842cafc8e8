#include "rift/simulation/motor.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

namespace rift::simulation {
namespace {

constexpr double kNmPerKgCm = 0.0980665;
constexpr double kCountsPerMotorRev = 12.0;  // Pololu 0J86/6.4

constexpr double kRest_rad_s = 1e-6;

GearingData Published(double no_load_rpm, double stall_kg_cm, double ratio) {
  return {no_load_rpm * 2.0 * std::numbers::pi / 60.0, stall_kg_cm * kNmPerKgCm,
          kCountsPerMotorRev * ratio};
}

}  // namespace

GearingData DataOf(Gearing gearing) {
  // Speed and torque: Pololu 0J83/5.3. The motors differ, so neither follows from the ratio of the
  // gears (0J86/6.4 and product pages), which gives the counts.
  switch (gearing) {
    case Gearing::k30To1:
      return Published(720.0, 0.33, 29.86);
    case Gearing::k75To1:
      return Published(180.0, 0.64, 75.81);
    case Gearing::k15To1:
      return Published(2100.0, 0.25, 15.25);
  }
  assert(false);
  return {};
}

void MotorOptions::Check() const {
  if (Breakaway_nm() >= friction_torque_nm) return;
  throw std::invalid_argument(
      fmt::format("breakaway_torque_nm is {}, but it must be at least friction_torque_nm, {}",
                  Breakaway_nm(), friction_torque_nm));
}

Motor::Motor(const MotorOptions& options, Side side)
    : options_(options),
      no_load_rad_s_(options.NoLoad_rad_s() *
                     (1.0 + (side == Side::kLeft ? 0.5 : -0.5) * options.mismatch)),
      nm_per_rad_s_(options.StallTorque_nm() / no_load_rad_s_) {}

WheelDrive Motor::Drive(const StepPower& power, double rate_rad_s, double drag_nm, double step_s) {
  if (options_.model == MotorModel::kServo) {
    return {power.mean * options_.supply_ratio * no_load_rad_s_, 0.0,
            options_.servo_torque_nm.value_or(std::numeric_limits<double>::infinity())};
  }
  const StepPower driven = ThroughLag(ThroughDeadBand(power), step_s);
  const double free_rad_s = driven.mean * options_.supply_ratio * no_load_rad_s_;
  const double friction_nm = Friction_nm(rate_rad_s) + drag_nm;
  WheelDrive drive{free_rad_s, 1.0 / nm_per_rad_s_, std::numeric_limits<double>::infinity()};
  const double running_rad_s = free_rad_s - std::copysign(friction_nm, rate_rad_s) / nm_per_rad_s_;
  if (std::abs(rate_rad_s) < kRest_rad_s) {
    drive.friction_nm = FrictionFromRest_nm(driven, drag_nm);
  } else if (running_rad_s * rate_rad_s > 0.0) {
    drive.target_rad_s = running_rad_s;  // it will not come to rest: one line holds all
  } else {
    drive.friction_nm = friction_nm;
  }
  return drive;
}

/// Stribeck's curve, of a wheel that turns.
double Motor::Friction_nm(double rate_rad_s) const {
  const double running_nm = options_.friction_torque_nm;
  if (options_.friction_fall_rad_s == 0.0) return running_nm;
  const double fallen = rate_rad_s / options_.friction_fall_rad_s;
  return running_nm + (options_.Breakaway_nm() - running_nm) * std::exp(-fallen * fallen);
}

StepPower Motor::ThroughDeadBand(const StepPower& power) const {
  const auto driven = [this](double p) { return std::abs(p) < options_.dead_band ? 0.0 : p; };
  const double before = driven(power.before), after = driven(power.after);
  return {before, before + power.ShareAfter() * (after - before), after};
}

StepPower Motor::ThroughLag(const StepPower& power, double step_s) {
  if (options_.lag_s == 0.0) return power;
  const double steps = step_s / options_.lag_s;
  const double passed = -std::expm1(-steps), before = lagged_power_;
  lagged_power_ += (power.mean - before) * passed;
  return {before, power.mean + (before - power.mean) * passed / steps, lagged_power_};
}

/// Mean friction over a step that begins at rest. While the wheel is held, friction is what the
/// motor asks for; from where the motor breaks it away, it is running friction. Without a lag the
/// power changes at one moment of the step, with it evenly.
double Motor::FrictionFromRest_nm(const StepPower& power, double drag_nm) const {
  const double running_nm = Friction_nm(0.0) + drag_nm;
  const double breakaway_nm = options_.Breakaway_nm() + drag_nm;
  const double stall_nm = nm_per_rad_s_ * options_.supply_ratio * no_load_rad_s_;
  const double side = std::copysign(1.0, power.after);
  const double before_nm = side * stall_nm * power.before,
               after_nm = std::abs(power.after) * stall_nm;
  if (after_nm <= breakaway_nm) return breakaway_nm;
  double driven = 1.0, held_nm = 0.0;
  if (options_.lag_s == 0.0) {
    driven = power.ShareAfter();
    held_nm = before_nm;
  } else if (before_nm < breakaway_nm) {
    driven = (after_nm - breakaway_nm) / (after_nm - before_nm);
    held_nm = 0.5 * (before_nm + breakaway_nm);
  }
  return driven * running_nm + (1.0 - driven) * std::abs(held_nm);
}

std::int64_t CountsAt(double angle_rad, double counts_per_rev) {
  return static_cast<std::int64_t>(
      std::floor(angle_rad * counts_per_rev / (2.0 * std::numbers::pi)));
}

}  // namespace rift::simulation
