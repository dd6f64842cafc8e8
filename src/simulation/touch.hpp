#pragma once

#include <Eigen/Core>
#include <optional>

#include "rift/simulation/terrain.hpp"

namespace rift::simulation {

/// Where a body touches the ground.
struct Touch {
  Eigen::Vector3d point;   ///< of the body, deepest below the ground, in the world frame
  Eigen::Vector3d normal;  ///< unit, from the ground into the body
  double depth_m = 0.0;    ///< positive inside the ground
};

/// An upright wheel as a disc: one point, the deepest. On a plane it is the lowest point of the
/// disc; elsewhere the point of the ground's profile nearest to the centre, so that the wheel
/// climbs an edge or a block instead of jumping onto it. `axle` is a unit vector to the left.
std::optional<Touch> TouchWheel(const Terrain& terrain, const Eigen::Vector3d& centre,
                                const Eigen::Vector3d& axle, double radius_m, double width_m);

/// A ball; `forward` is any horizontal direction in which the ground's profile is looked at.
std::optional<Touch> TouchBall(const Terrain& terrain, const Eigen::Vector3d& centre,
                               const Eigen::Vector3d& forward, double radius_m);

/// The lowest edge of a disc of the chassis, whose axis is the unit vector `up`.
std::optional<Touch> TouchRim(const Terrain& terrain, const Eigen::Vector3d& centre,
                              const Eigen::Vector3d& up, double radius_m);

}  // namespace rift::simulation
