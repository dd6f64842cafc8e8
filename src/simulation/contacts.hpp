#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

#include "rift/simulation/body.hpp"
#include "rift/simulation/ode_world.hpp"
#include "rift/simulation/terrain.hpp"

namespace rift::simulation {

/// Where a body touches the ground.
struct ContactPoint {
  Eigen::Vector3d point;   ///< of the body, deepest below the ground, in the world frame
  Eigen::Vector3d normal;  ///< unit, from the ground into the body
  double depth_m = 0.0;    ///< positive inside the ground
};

/// An upright wheel as a disc: one point, the deepest. On a plane it is the lowest point of the
/// disc; elsewhere the point of the ground's profile nearest to the centre, so that the wheel
/// climbs an edge or a block instead of jumping onto it. `axle` is a unit vector to the left.
std::optional<ContactPoint> WheelContactPoint(const Terrain& terrain, const Eigen::Vector3d& centre,
                                              const Eigen::Vector3d& axle, double radius_m,
                                              double width_m);

/// A ball; `forward` is any horizontal direction in which the ground's profile is looked at.
std::optional<ContactPoint> BallContactPoint(const Terrain& terrain, const Eigen::Vector3d& centre,
                                             const Eigen::Vector3d& forward, double radius_m);

/// The lowest edge of a disc of the chassis, whose axis is the unit vector `up`.
std::optional<ContactPoint> RimContactPoint(const Terrain& terrain, const Eigen::Vector3d& centre,
                                            const Eigen::Vector3d& up, double radius_m);

/// Where the robot touches the ground and how well it holds there.
struct GroundContact {
  ContactPoint at;
  double mu = 0.0;
  /// Unit, in the ground: friction acts along it and across it, and gives way to a force by
  /// `slip_mps_per_n` in both. Without it friction acts against the motion and does not give way.
  std::optional<Eigen::Vector3d> sideways = {};
  double slip_mps_per_n = 0.0;
};

/// `side` is 0 for the left wheel and 1 for the right one; `wheel_load_n` presses it on level
/// ground.
std::optional<GroundContact> WheelContact(const BodyOptions& body, const Terrain& terrain,
                                          const WorldState& state, int side,
                                          const Eigen::Vector3d& centre, double wheel_load_n);

std::optional<GroundContact> CasterContact(const BodyOptions& body, const Terrain& terrain,
                                           const WorldState& state);

/// The lower edge of the chassis, which touches where the robot pitches or an obstacle lies.
std::optional<GroundContact> RimContact(const BodyOptions& body, const Terrain& terrain,
                                        const WorldState& state);

/// Why the motion cannot go on from this state: a number that is not finite, a robot that tipped
/// over, sank through the floor or fell off the table. Nothing when it can.
std::optional<std::string> FaultOf(const WorldState& state, const Terrain& terrain);

}  // namespace rift::simulation
