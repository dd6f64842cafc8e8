#pragma once

#include <cmath>

#include "rift/view/film.hpp"

namespace rift::view::synthetic {

/// Straight ahead at 0.2 m/s for 2 s from (0, 0), turned by `yaw_rad`, a pose each 50 ms; two
/// waypoints, at the start and at the end, and a measured position for every true one.
inline Run StraightRun(double yaw_rad = 0.0) {
  Run run;
  run.title = "straight";
  const Eigen::Vector2d forward(std::cos(yaw_rad), std::sin(yaw_rad));
  run.waypoints = {{"start", {0.0, 0.0}}, {"end", 0.4 * forward}};
  run.outcome = "reached";
  for (int i = 0; i <= 40; ++i) {
    const Eigen::Vector2d p_m = 0.01 * i * forward;
    run.truth.poses.push_back({.t_s = 5.0 + 0.05 * i,
                               .x_m = p_m.x(),
                               .y_m = p_m.y(),
                               .z_m = 0.016,
                               .roll_rad = 0.0,
                               .pitch_rad = 0.0,
                               .yaw_rad = yaw_rad,
                               .target_x_m = run.waypoints[1].p_in_world_m.x(),
                               .target_y_m = run.waypoints[1].p_in_world_m.y()});
  }
  run.logged = run.truth;
  run.logged.channels = {{"power_left", std::vector<double>(41, 0.2)},
                         {"power_right", std::vector<double>(41, 0.18)}};
  return run;
}

}  // namespace rift::view::synthetic
