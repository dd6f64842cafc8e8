#pragma once

#include <optional>

#include "rift/control/diff_drive.hpp"
#include "rift/control/pid.hpp"

namespace rift::control {

/// Which poses are believed. The limits lie well above what the robot can do (0.75 m/s at half
/// power, 14 rad/s at the largest steering), since noise adds to them.
struct PoseGateOptions {
  double max_speed_mps = 2.0;
  double max_yaw_rate_rad_s = 30.0;
  double min_interval_s = 0.02;

  /// Calls field(key, member, [min, max,] help) for every member; min and max are inclusive.
  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    field("max_speed_mps", self.max_speed_mps, 1e-3, 1e6,
          "a pose that implies more than this since the last one believed is refused");
    field("max_yaw_rate_rad_s", self.max_yaw_rate_rad_s, 1e-3, 1e6,
          "a pose that implies a faster turn since the last one believed is refused");
    field("min_interval_s", self.min_interval_s, 0.0, 1.0,
          "shorter intervals count as this long, so that noise is no jump");
  }
};

/// The pose is predicted through the commands whose effect has not been seen yet.
struct LatencyOptions {
  double delay_s = 0.0;
  DiffDriveOptions drive;

  /// Calls field(key, member, [min, max,] help) for every member; min and max are inclusive.
  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    field("delay_s", self.delay_s, 0.0, 2.0,
          "loop delay made up for: from a command to its effect in an arriving pose; 0 is off");
    field("drive", self.drive, "model of the robot used for the prediction");
  }
};

/// The dual-loop waypoint controller; every default is the authors' published value unless the
/// feature is ours, and then it is off. Powers and their limits are shares of full power.
struct NavigatorOptions {
  PidGains distance{0.9, 0.0, 0.01};
  PidGains heading{0.045, 0.0, 0.0085};
  double integral_limit = 2.0;
  /// The authors' Webots logs show it: |w| is 0.027 to 0.045 in the first step of each new leg
  /// and 0.02 elsewhere, and v_max 0.30 and 0.40 part in exactly one such step.
  bool derivative_kick = true;
  bool first_pose_sets_clock = false;
  bool clock_starts_anew = false;
  double reach_radius_m = 0.05;
  double v_min = 0.15;
  double v_max = 0.30;
  double w_min = 0.02;
  double w_max = 0.5;
  std::optional<double> cruise_speed;
  double cruise_cap_angle_deg = 15.0;
  double through_angle_deg = 10.0;
  double dt_min_s = 0.005;
  double dt_max_s = 0.1;
  std::optional<double> slew_rate_per_s;
  PoseGateOptions pose_gate;
  LatencyOptions latency;

  /// Calls field(key, member, [min, max,] help) for every member; min and max are inclusive.
  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    field("distance", self.distance, "loop from distance (m) to forward power");
    field("heading", self.heading, "loop from heading error (rad) to steering power");
    field("integral_limit", self.integral_limit, 0.0, 1e3, "bound of both error integrals");
    field("derivative_kick", self.derivative_kick,
          "the error before a leg counts as zero, so its first step has a derivative");
    field("first_pose_sets_clock", self.first_pose_sets_clock,
          "the first decision of a drive only sets the clock, at zero power, as in the authors' "
          "loop: the first that drives knows a true interval");
    field("clock_starts_anew", self.clock_starts_anew,
          "the same at the start and after each stop, as in the authors' loop, whose robot is seen "
          "to halt at 63 % of its stops");
    field("reach_radius_m", self.reach_radius_m, 1e-4, 10.0, "a waypoint is reached within this");
    field("v_min", self.v_min, 0.0, 1.0, "least forward power between waypoints");
    field("v_max", self.v_max, 0.0, 1.0, "largest forward power");
    field("w_min", self.w_min, 0.0, 1.0, "least steering power, either way");
    field("w_max", self.w_max, 0.0, 1.0, "largest steering power, either way");
    field("cruise_speed", self.cruise_speed, 0.0, 1.0, "forward power on a leg; unset: v_max");
    field("cruise_cap_angle_deg", self.cruise_cap_angle_deg, 0.0, 180.0,
          "cruise speed is the limit while the heading error is smaller");
    field("through_angle_deg", self.through_angle_deg, 0.0, 180.0,
          "cruise speed is kept to a waypoint without stop while the heading error is smaller");
    field("dt_min_s", self.dt_min_s, 1e-4, 1.0, "shorter control steps count as this long");
    field("dt_max_s", self.dt_max_s, 1e-4, 10.0, "longer control steps count as this long");
    field("slew_rate_per_s", self.slew_rate_per_s, 1e-3, 1e6,
          "largest change of a wheel's power in a second; unset: no limit");
    field("pose_gate", self.pose_gate, "poses that cannot be are refused");
    field("latency", self.latency, "compensation of the loop delay");
  }

  /// Rules between fields; throws std::invalid_argument naming field, value and rule.
  void Check() const;
  double CruiseSpeed() const { return cruise_speed.value_or(v_max); }
};

}  // namespace rift::control
