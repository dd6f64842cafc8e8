#pragma once

#include <vector>

#include "rift/control/waypoint.hpp"
#include "rift/trial/steering_check.hpp"

namespace rift::trial {

// The fake robot's: 75.4 rad/s on wheels of 16 mm, 83 mm apart.
constexpr double kSpeed_mps = 75.4 * 0.016;
constexpr double kYawRate_rad_s = 2.0 * kSpeed_mps / 0.083;
inline const SteeringPrior kPrior{{kSpeed_mps, kYawRate_rad_s, 0.0, 0.0}, 0.1};

/// A task on which the fake robot steers by its own poses.
inline const std::vector<control::Waypoint> kTask{
    {.name = "start", .x_m = 0.0, .y_m = 0.0, .heading_deg = 20.0},
    {.name = "a", .x_m = 0.4, .y_m = 0.05, .stop = true},
    {.name = "b", .x_m = 0.5, .y_m = 0.3, .stop = true}};

}  // namespace rift::trial
