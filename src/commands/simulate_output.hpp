#pragma once

#include <string>

#include "rift/config/experiment.hpp"
#include "rift/sweep/simulated_trial.hpp"

namespace rift::commands {

/// Outcome, times, waypoints, which limits of the controller were binding, seed and version.
std::string SimulationJson(const config::Experiment& experiment, const sweep::SimulatedRun& run);

/// The same in a few lines for the terminal.
std::string SimulationText(const config::Experiment& experiment, const sweep::SimulatedRun& run);

}  // namespace rift::commands
