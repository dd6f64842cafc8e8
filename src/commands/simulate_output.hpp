#pragma once

#include <string>

#include "rift/experiment/experiment.hpp"
#include "rift/sweep/falsify/simulated_trial.hpp"

namespace rift::commands {

/// Outcome, times, waypoints, which limits of the controller were binding, seed and version.
std::string SimulationJson(const experiment::Experiment& experiment,
                           const sweep::SimulatedRun& run);

/// The same in a few lines for the terminal.
std::string SimulationText(const experiment::Experiment& experiment,
                           const sweep::SimulatedRun& run);

}  // namespace rift::commands
