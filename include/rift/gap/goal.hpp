#pragma once

#include <Eigen/Core>

#include "rift/gap/options.hpp"
#include "rift/trajectory/trajectory.hpp"

namespace rift::gap {

/// Where a run may end: a robot stops as soon as it is within `radius_m` of the goal.
struct Goal {
  Eigen::Vector2d position_m;  ///< in the frame of the paths
  double radius_m = 0.0;
};

/// The gap on the way: the gap after each path that stopped short of the goal, within its radius,
/// went straight on until it was level with it. How short a run stops is then no part of it; how
/// far it passes beside the goal is. Equal to the gap for paths that end elsewhere or beyond the
/// goal. Goals stand in the plane, so in space it is the gap itself. Throws std::invalid_argument
/// as Compare does.
double WayGap_m(const trajectory::Trajectory& sim, const trajectory::Trajectory& real,
                const Goal& goal, const GapOptions& options);

}  // namespace rift::gap
