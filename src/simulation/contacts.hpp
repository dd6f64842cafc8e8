#pragma once

#include <Eigen/Core>
#include <optional>

#include "rift/simulation/body.hpp"
#include "rift/simulation/ode_world.hpp"
#include "rift/simulation/terrain.hpp"
#include "touch.hpp"

namespace rift::simulation {

/// Where the robot touches the ground and how well it holds there.
struct GroundContact {
  Touch touch;
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

}  // namespace rift::simulation
