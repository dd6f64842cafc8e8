#pragma once

#include <cstdint>

#include "rift/geometry/pose2.hpp"

namespace rift::control {

/// Motor power of the two wheels as a share of full power, each in [-1, 1]; forward positive.
struct WheelPower {
  double left = 0.0;
  double right = 0.0;

  friend bool operator==(const WheelPower&, const WheelPower&) = default;
};

/// Counts of the quadrature encoders since the start; forward positive.
struct EncoderCounts {
  std::int64_t left = 0;
  std::int64_t right = 0;

  friend bool operator==(const EncoderCounts&, const EncoderCounts&) = default;
};

/// Geometry and gearing of a robot with two driven wheels on one axle (facts: the authors' world
/// file and Pololu 0J83/5.3 for the 3pi+ with 30:1 motors).
struct DiffDriveOptions {
  double wheel_radius_m = 0.016;
  double track_m = 0.083;
  double full_power_speed_rad_s = 75.4;

  /// Calls field(key, member, [min, max,] help) for every member; min and max are inclusive.
  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    field("wheel_radius_m", self.wheel_radius_m, 1e-3, 1.0, "radius of a driven wheel");
    field("track_m", self.track_m, 1e-3, 5.0, "distance between the centres of the wheels");
    field("full_power_speed_rad_s", self.full_power_speed_rad_s, 1e-3, 1e4,
          "wheel speed at power 1 without load (720 rpm)");
  }
};

/// Turning speed of the wheels about the axle; forward positive.
struct WheelSpeed {
  double left_rad_s = 0.0;
  double right_rad_s = 0.0;
};

/// Velocity of the middle of the axle along the body's forward axis, and of the yaw
/// (counter-clockwise positive).
struct Twist {
  double forward_mps = 0.0;
  double yaw_rate_rad_s = 0.0;
};

/// Wheels that roll without slip and motors that turn in proportion to their power.
class DiffDrive {
 public:
  /// Throws std::invalid_argument unless every length and speed is finite and above zero.
  explicit DiffDrive(const DiffDriveOptions& options = {});

  const DiffDriveOptions& options() const { return options_; }

  WheelSpeed SpeedAtPower(const WheelPower& power) const;
  Twist BodyTwist(const WheelSpeed& speed) const;
  WheelSpeed WheelsFor(const Twist& twist) const;
  /// world_from_robot after `dt_s` seconds at a constant power, along the exact arc.
  geometry::Pose2 Drive(const geometry::Pose2& world_from_robot, const WheelPower& power,
                        double dt_s) const;

 private:
  DiffDriveOptions options_;
};

/// start_from_end of a motion along a circular arc: `length_m` along it, turning by `turn_rad`.
geometry::Pose2 ArcMotion(double length_m, double turn_rad);

}  // namespace rift::control
