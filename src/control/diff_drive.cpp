#include "rift/control/diff_drive.hpp"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

namespace rift::control {
namespace {

// Below this turn the series of sin(a)/a and (1 - cos(a))/a are exact to double precision.
constexpr double kSmallTurn_rad = 1e-4;

void CheckAboveZero(const char* name, double value) {
  if (std::isfinite(value) && value > 0.0) return;
  throw std::invalid_argument(
      fmt::format("{} is {}, and it must be finite and above zero", name, value));
}

}  // namespace

DiffDrive::DiffDrive(const DiffDriveOptions& options) : options_(options) {
  CheckAboveZero("wheel_radius_m", options.wheel_radius_m);
  CheckAboveZero("track_m", options.track_m);
  CheckAboveZero("full_power_speed_rad_s", options.full_power_speed_rad_s);
}

WheelSpeed DiffDrive::SpeedAtPower(const WheelPower& power) const {
  return {power.left * options_.full_power_speed_rad_s,
          power.right * options_.full_power_speed_rad_s};
}

Twist DiffDrive::BodyTwist(const WheelSpeed& speed) const {
  const double left_mps = speed.left_rad_s * options_.wheel_radius_m;
  const double right_mps = speed.right_rad_s * options_.wheel_radius_m;
  return {0.5 * (left_mps + right_mps), (right_mps - left_mps) / options_.track_m};
}

WheelSpeed DiffDrive::WheelsFor(const Twist& twist) const {
  const double half_turn_mps = 0.5 * options_.track_m * twist.yaw_rate_rad_s;
  return {(twist.forward_mps - half_turn_mps) / options_.wheel_radius_m,
          (twist.forward_mps + half_turn_mps) / options_.wheel_radius_m};
}

geometry::Pose2 DiffDrive::Drive(const geometry::Pose2& world_from_robot, const WheelPower& power,
                                 double dt_s) const {
  const Twist twist = BodyTwist(SpeedAtPower(power));
  return world_from_robot * ArcMotion(twist.forward_mps * dt_s, twist.yaw_rate_rad_s * dt_s);
}

geometry::Pose2 ArcMotion(double length_m, double turn_rad) {
  double along = 1.0 - turn_rad * turn_rad / 6.0;
  double across = 0.5 * turn_rad;
  if (std::abs(turn_rad) > kSmallTurn_rad) {
    along = std::sin(turn_rad) / turn_rad;
    across = (1.0 - std::cos(turn_rad)) / turn_rad;
  }
  return {length_m * along, length_m * across, turn_rad};
}

}  // namespace rift::control
