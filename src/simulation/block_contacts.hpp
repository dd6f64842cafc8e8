#pragma once

#include <Eigen/Core>
#include <vector>

#include "contacts.hpp"
#include "rift/simulation/terrain.hpp"

namespace rift::simulation {

/// A circle in space that a ball rolls along: a tyre (its centre line and its roundness), the edge
/// of the chassis, or, without a radius, the ball of a caster.
struct RoundEdge {
  Eigen::Vector3d centre;
  Eigen::Vector3d axis;      ///< unit, across the circle
  double radius_m = 0.0;     ///< of the circle
  double roundness_m = 0.0;  ///< of the ball
};

/// Where it touches blocks and the floor between them, or comes within `margin_m` of them: one
/// contact with each block and one with the floor. A depth is how far the ball reaches beyond the
/// nearest point of a block, negative for one ahead of it, so it changes steadily however the body
/// moves, and contact forces along the normals can give back no more than they took.
std::vector<ContactPoint> ContactsWithBlocks(const std::vector<Block>& blocks,
                                             const RoundEdge& edge, double margin_m);

}  // namespace rift::simulation
