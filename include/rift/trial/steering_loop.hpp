#pragma once

#include <algorithm>
#include <numbers>

#include "rift/control/options.hpp"

namespace rift::trial {

/// How a robot answers the steering: forward speed and yaw rate in proportion to v and w, late.
struct SteeringModel {
  double speed_mps = 0.0;        ///< forward, for each unit of v
  double yaw_rate_rad_s = 0.0;   ///< for each unit of w, which is half of power_right - power_left
  double pose_age_s = 0.0;       ///< mean age of the pose that a decision is made on
  double command_delay_s = 0.0;  ///< from a command to the motion it causes
  double pull_rad_s = 0.0;  ///< yaw rate without steering, for each unit of v; above 0 to the left
};

/// What a robot's file says of it, for a run that does not tell.
struct SteeringPrior {
  SteeringModel model;
  double dead_band = 0.0;        ///< smaller powers do not reach the motors
  double breakaway_power = 0.0;  ///< smaller ones do not turn a wheel at rest, by its friction

  double MovingPower() const { return std::max(dead_band, breakaway_power); }
  /// A wheel turns evenly a little above what turns it at all.
  double LeastPower() const { return 1.2 * MovingPower(); }
};

/// The heading error of a robot that circles its waypoint.
constexpr double kQuarterTurn_rad = 0.5 * std::numbers::pi;

/// Forward and turning part of the power of the wheels.
struct SteeringCommand {
  double v, w;
};

/// w for a heading error, before its limits, with the integral at its own.
double SteeringAt(const control::NavigatorOptions& navigator, double error_rad);

/// v and w on the circle round a waypoint, after every limit.
SteeringCommand OnCircle(const control::NavigatorOptions& navigator, const SteeringModel& model);

/// Yaw rate to the side against which the robot pulls.
double TurnAgainstPull_rad_s(const SteeringModel& model, double v, double w);

/// w that drives straight against the robot's pull.
double HoldSteering(const SteeringModel& model, double v);

/// The heading error that makes the controller steer so, beside the integral at its limit; infinite
/// when it never does.
double HoldError_rad(const control::NavigatorOptions& navigator, double hold_w);

/// Stability of the heading loop far from its waypoint: gain (p + i / s + d s) / s with a delay.
struct SteeringMargins {
  double crossover_rad_s = 0.0;   ///< where the loop's gain is 1; infinite when it never falls to 1
  double phase_margin_deg = 0.0;  ///< below 0: unstable
  double longest_delay_s = 0.0;   ///< at which the margin is 0
};

/// Closed form. `yaw_rate_rad_s` as in SteeringModel.
SteeringMargins MarginsOf(const control::PidGains& heading, double yaw_rate_rad_s, double delay_s);

/// Radius of the circle on which the robot drives round a waypoint for ever: the heading error
/// stays at 90 degrees there, and a delay changes nothing. To the side against which the robot
/// pulls; infinite when it cannot turn to it.
double CircleRadius_m(const control::NavigatorOptions& navigator, const SteeringModel& model);

/// How far w_min alone swings the robot: its sign changes a delay after the heading error's.
struct SteeringSwing {
  double heading_rad = 0.0;  ///< to each side
  double path_m = 0.0;       ///< to each side, at v_min
};
SteeringSwing SwingOf(const control::NavigatorOptions& navigator, const SteeringModel& model,
                      double delay_s);

}  // namespace rift::trial
