#pragma once

#include "rift/control/controller.hpp"
#include "rift/control/options.hpp"
#include "rift/trial/options.hpp"
#include "rift/trial/steering_loop.hpp"

namespace rift::trial {

/// Gains with the wanted margin: the loop's gain is 1 where the delay alone costs the rest, so that
/// d adds to the margin (w T = pi / 2 - margin).
control::PidGains StableGains(const control::NavigatorOptions& navigator, double yaw_rate_rad_s,
                              double delay_s);

/// More gain as far as it stays stable, then less speed, which pulls less, as far as the wheels
/// turn.
void HoldAgainstPull(const SteeringModel& model, const SteeringPrior& prior,
                     const control::PidGains& largest, control::NavigatorOptions& wanted);

/// Steering strong enough for a circle within the reach radius, as far as it stays stable; then a
/// lower speed, as far as the wheels turn; then a larger radius.
void TightenCircle(const SteeringModel& model, const SteeringPrior& prior,
                   const control::PidGains& largest, control::NavigatorOptions& wanted);

/// Twice the time the task takes when it is driven straight, with a turn to each waypoint.
double NeededTime_s(const control::Task& task, const control::NavigatorOptions& navigator,
                    const SteeringModel& model, double delay_s, const TrialOptions& options);

}  // namespace rift::trial
