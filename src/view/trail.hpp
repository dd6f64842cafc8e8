#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "rift/view/track_scene.hpp"

namespace rift::view {

/// So many points a trail has at most, at least 8 m of it; then the oldest are left out.
inline constexpr std::size_t kTrailLength = 4000;

/// Adds a point to a robot's trail, unless it is within two millimetres of the last one, and how it
/// lies beside the path; fewer than two points are no path. What was added before is not looked at
/// again, so that a picture costs the same however long the robot has driven.
void ExtendTrail(const Eigen::Vector2d& p_m, const std::vector<Eigen::Vector2d>& path_m,
                 SceneRobot& robot);

/// Forgets the trail and how it lay beside the path.
void ClearTrail(SceneRobot& robot);

}  // namespace rift::view
