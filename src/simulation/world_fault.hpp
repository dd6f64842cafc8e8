#pragma once

#include <optional>
#include <string>

#include "rift/simulation/ode_world.hpp"
#include "rift/simulation/terrain.hpp"

namespace rift::simulation {

/// Why the motion cannot go on from this state: a number that is not finite, a robot that tipped
/// over, sank through the floor or fell off the table. Nothing when it can.
std::optional<std::string> FaultOf(const WorldState& state, const Terrain& terrain);

}  // namespace rift::simulation
