#pragma once

#include <string>

#include "rift/experiment/experiment.hpp"
#include "rift/sweep/falsify/simulated_trial.hpp"

namespace rift::report {

/// Outcome, times, waypoints, and whether the speed limit was ever binding.
std::string SimulationText(const experiment::Experiment& experiment,
                           const sweep::SimulatedRun& run);

}  // namespace rift::report
