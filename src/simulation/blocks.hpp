#pragma once

#include <Eigen/Core>
#include <vector>

#include "contacts.hpp"
#include "rift/simulation/terrain.hpp"

namespace rift::simulation {

/// All points within `sweep_m` of a disc: a tyre with a round shoulder, or a ball (radius 0).
/// World frame; `axis` is the unit normal of the disc.
struct SweptDisc {
  Eigen::Vector3d centre;
  Eigen::Vector3d axis;
  double radius_m = 0.0;
  double sweep_m = 0.0;
};

/// An upright box with sides along the axes of the world.
struct Block {
  Eigen::Vector3d low;
  Eigen::Vector3d high;
};

/// Where the two touch or would: depth_m is negative while they are apart.
ContactPoint BlockContact(const SweptDisc& disc, const Block& block);

/// Appends where the disc touches the floor and the blocks of a terrain of bumps, or is less than
/// `margin_m` away: one point for each of these convex bodies. The distance to a convex body and
/// its direction change without a jump however the disc moves, which is what keeps contact forces
/// from doing work of their own.
void BumpContacts(const Terrain& terrain, const SweptDisc& disc, double margin_m,
                  std::vector<ContactPoint>& contacts);

}  // namespace rift::simulation
