#include "rift/trial/steering_loop.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "rift/geometry/pose2.hpp"

namespace rift::trial {

using control::NavigatorOptions;
using geometry::DegFromRad;

double SteeringAt(const NavigatorOptions& navigator, double error_rad) {
  return navigator.heading.p * error_rad + navigator.heading.i * navigator.integral_limit;
}

double TurnAgainstPull_rad_s(const SteeringModel& model, double v, double w) {
  return model.yaw_rate_rad_s * w - std::abs(model.pull_rad_s) * v;
}

SteeringCommand OnCircle(const NavigatorOptions& navigator, const SteeringModel& model) {
  const double w =
      std::clamp(SteeringAt(navigator, kQuarterTurn_rad), navigator.w_min, navigator.w_max);
  // v follows the distance once that asks for more than the circle of v_min leaves.
  const bool grows =
      model.speed_mps * navigator.distance.p > TurnAgainstPull_rad_s(model, navigator.v_min, w);
  return {grows ? navigator.v_max : navigator.v_min, w};
}

double HoldSteering(const SteeringModel& model, double v) {
  return std::abs(model.pull_rad_s) * v / model.yaw_rate_rad_s;
}

double HoldError_rad(const NavigatorOptions& navigator, double hold_w) {
  if (hold_w > navigator.w_max) return std::numeric_limits<double>::infinity();
  const double beside_integral = hold_w - SteeringAt(navigator, 0.0);
  return hold_w > navigator.w_min && beside_integral > 0.0 ? beside_integral / navigator.heading.p
                                                           : 0.0;
}

SteeringMargins MarginsOf(const control::PidGains& heading, double yaw_rate_rad_s, double delay_s) {
  // |L(i w)| = 1 is a quadratic equation in w^2:
  // (1 - G^2 d^2) w^4 - G^2 (p^2 - 2 i d) w^2 = G^2 i^2.
  const double g2 = yaw_rate_rad_s * yaw_rate_rad_s;
  const double a = 1.0 - g2 * heading.d * heading.d,
               b = g2 * (heading.p * heading.p - 2.0 * heading.i * heading.d),
               c = g2 * heading.i * heading.i;
  if (!(a > 0.0)) return {std::numeric_limits<double>::infinity(), -180.0, 0.0};
  const double crossover_rad_s = std::sqrt((b + std::sqrt(b * b + 4.0 * a * c)) / (2.0 * a));
  if (!(crossover_rad_s > 0.0)) return {0.0, 90.0, std::numeric_limits<double>::infinity()};
  const double lead_rad =
      kQuarterTurn_rad +
      std::atan2(crossover_rad_s * heading.d - heading.i / crossover_rad_s, heading.p);
  return {crossover_rad_s, DegFromRad(lead_rad - crossover_rad_s * delay_s),
          lead_rad / crossover_rad_s};
}

double CircleRadius_m(const NavigatorOptions& navigator, const SteeringModel& model) {
  const SteeringCommand asked = OnCircle(navigator, model);
  const double turn_rad_s = TurnAgainstPull_rad_s(model, asked.v, asked.w);
  return turn_rad_s > 0.0 ? model.speed_mps * asked.v / turn_rad_s
                          : std::numeric_limits<double>::infinity();
}

SteeringSwing SwingOf(const NavigatorOptions& navigator, const SteeringModel& model,
                      double delay_s) {
  // A triangle of the heading: up for two delays, down for two.
  const double heading_rad = model.yaw_rate_rad_s * navigator.w_min * delay_s;
  return {heading_rad, 0.5 * model.speed_mps * navigator.v_min * heading_rad * delay_s};
}

}  // namespace rift::trial
