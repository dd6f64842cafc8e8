#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "rift/simulation/body.hpp"
#include "rift/simulation/ode_world.hpp"
#include "rift/simulation/terrain.hpp"

namespace rift::simulation {

/// Where a body touches the ground.
struct ContactPoint {
  Eigen::Vector3d point;   ///< of the body, deepest below the ground, in the world frame
  Eigen::Vector3d normal;  ///< unit, from the ground into the body
  double depth_m = 0.0;    ///< positive inside the ground, negative for one about to be touched
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

/// The lowest edge of a disc of the chassis, whose axis is the unit vector `up`. On ground that is
/// no plane eight points of the edge are looked at, the first towards the unit vector `forward`.
std::optional<ContactPoint> RimContactPoint(const Terrain& terrain, const Eigen::Vector3d& centre,
                                            const Eigen::Vector3d& forward,
                                            const Eigen::Vector3d& up, double radius_m);

/// Where the robot touches the ground and how well it holds there. Friction acts along `direction`
/// and across it, each up to mu times the load; at that limit the ground gives way by its creep.
struct GroundContact {
  ContactPoint at;
  double mu = 0.0;
  Eigen::Vector3d direction = Eigen::Vector3d::UnitX();  ///< unit, in the ground
  double creep_along_mps = 0.0;
  double creep_across_mps = 0.0;
  double usual_load_n = 0.0;  ///< at rest on level ground
  /// A wheel rolls across `direction` faster than its rim turns by this.
  double uneven_mps = 0.0;
};

/// The robot and the ground under it, as the contacts of one step see them.
struct ContactScene {
  const BodyOptions& body;
  const Terrain& terrain;
  const WorldState& state;
  /// For each wheel: the way it makes beyond what its rim turns, as a share of it.
  std::array<double, 2> uneven{};
  /// A part nearer than this to a block may run into it within the step.
  double margin_m = 0.0;
};

/// Each appends its contacts. `side` is 0 for the left wheel and 1 for the right one, `centre` the
/// wheel's in the world frame.
void AddWheelContacts(const ContactScene& scene, int side, const Eigen::Vector3d& centre,
                      std::vector<GroundContact>& contacts);
/// The caster's ball slides: its friction points against its motion, whatever the heading.
void AddCasterContacts(const ContactScene& scene, std::vector<GroundContact>& contacts);
/// The lower edge of the chassis, which touches where the robot pitches or an obstacle lies.
void AddRimContacts(const ContactScene& scene, std::vector<GroundContact>& contacts);

/// Why the motion cannot be computed from this state on: a number that is not finite, a robot that
/// sank through the floor. Nothing when it can.
std::optional<std::string> FaultOf(const WorldState& state, const Terrain& terrain);
/// How and where a robot in this state ended its drive: it tipped over or fell off the table.
std::optional<std::string> FallOf(const WorldState& state, const Terrain& terrain);

}  // namespace rift::simulation
