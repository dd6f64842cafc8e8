#include "wanted_steering.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace rift::trial {
namespace {

using control::NavigatorOptions;

constexpr double kWantedMargin_rad = std::numbers::pi / 3.0;
constexpr double kCircleShare = 0.8;  // of the reach radius, wanted
constexpr double kWantedHold_rad = 0.5;

}  // namespace

control::PidGains StableGains(const NavigatorOptions& navigator, double yaw_rate_rad_s,
                              double delay_s) {
  const control::PidGains& now = navigator.heading;
  const double crossover_rad_s = (kQuarterTurn_rad - kWantedMargin_rad) / delay_s;
  const double ratio_s = now.p > 0.0 ? std::min(now.d / now.p, 0.5 * delay_s) : 0.0;
  const double p = crossover_rad_s / (yaw_rate_rad_s * std::hypot(1.0, crossover_rad_s * ratio_s));
  return {p, 0.0, ratio_s * p};
}

void HoldAgainstPull(const SteeringModel& model, const SteeringPrior& prior,
                     const control::PidGains& largest, NavigatorOptions& wanted) {
  const double beside_integral = HoldSteering(model, wanted.v_max) - SteeringAt(wanted, 0.0);
  const double p = std::min(beside_integral / kWantedHold_rad, largest.p);
  if (p > wanted.heading.p) wanted.heading = {p, wanted.heading.i, p * largest.d / largest.p};
  const double fast =
      SteeringAt(wanted, kWantedHold_rad) * model.yaw_rate_rad_s / std::abs(model.pull_rad_s);
  wanted.v_max = std::min(wanted.v_max, std::max(fast, prior.LeastPower()));
  wanted.v_min = std::min(wanted.v_min, wanted.v_max);
  wanted.w_max = std::max(wanted.w_max, 2.0 * HoldSteering(model, wanted.v_max));
}

void TightenCircle(const SteeringModel& model, const SteeringPrior& prior,
                   const control::PidGains& largest, NavigatorOptions& wanted) {
  const double inside_m = kCircleShare * wanted.reach_radius_m;
  const auto needed_w = [&] {
    return wanted.v_min * (model.speed_mps / inside_m + std::abs(model.pull_rad_s)) /
           model.yaw_rate_rad_s;
  };
  const double strongest_w = 1.0 - wanted.v_min;  // beyond, both powers are scaled down
  const double p = std::min(needed_w() / kQuarterTurn_rad, largest.p);
  if (p > wanted.heading.p) wanted.heading = {p, wanted.heading.i, p * largest.d / largest.p};
  wanted.w_max = std::max(
      wanted.w_max, std::min({needed_w(), SteeringAt(wanted, kQuarterTurn_rad), strongest_w}));
  const double w = std::clamp(SteeringAt(wanted, kQuarterTurn_rad), wanted.w_min, wanted.w_max);
  if (needed_w() > w * (1.0 + 1e-9)) {
    const double slow = wanted.v_min * w / needed_w();
    wanted.v_min = std::min(wanted.v_min, std::max(slow, prior.LeastPower()));
  }
  const double turn_rad_s = TurnAgainstPull_rad_s(model, wanted.v_min, w);
  if (!(turn_rad_s > 0.0)) return;  // nothing turns it against its pull
  wanted.distance.p = std::min(wanted.distance.p, kCircleShare * turn_rad_s / model.speed_mps);
  wanted.reach_radius_m =
      std::max(wanted.reach_radius_m, CircleRadius_m(wanted, model) / kCircleShare);
}

double NeededTime_s(const control::Task& task, const NavigatorOptions& navigator,
                    const SteeringModel& model, double delay_s, const TrialOptions& options) {
  constexpr int kParts = 100;
  const double turn_s =
      std::numbers::pi / std::max(1e-6, model.yaw_rate_rad_s * OnCircle(navigator, model).w) +
      2.0 * delay_s;
  double time_s = 0.0;
  for (size_t i = 1; i < task.waypoints.size(); ++i) {
    const double leg_m = (task.waypoints[i].Position() - task.waypoints[i - 1].Position()).norm();
    for (int part = 0; part < kParts; ++part) {
      const double v = std::clamp(navigator.distance.p * leg_m * (part + 0.5) / kParts,
                                  navigator.v_min, navigator.v_max);
      time_s += leg_m / kParts / std::max(1e-6, model.speed_mps * v);
    }
    time_s += turn_s;
  }
  return 2.0 * time_s + options.settle_s;
}

}  // namespace rift::trial
