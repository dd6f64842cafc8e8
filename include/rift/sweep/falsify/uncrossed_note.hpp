#pragma once

#include <optional>
#include <string>

#include "rift/sweep/falsify/simulated_trial.hpp"

namespace rift::sweep {

/// A line about a heightfield that the ideal path of the task crosses nowhere, as when its width is
/// in another unit or its centre elsewhere: the robot drives on the floor around it. Nothing for
/// one that is crossed, and for other surfaces.
std::optional<std::string> UncrossedNote(const SimulatedTrial& trial);

}  // namespace rift::sweep
