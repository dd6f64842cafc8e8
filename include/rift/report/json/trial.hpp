#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "rift/experiment/experiment.hpp"
#include "rift/sweep/falsify/simulated_trial.hpp"
#include "rift/trial/trial.hpp"

namespace rift::report {

/// What the summaries of a simulated and of a real trial have in common.
nlohmann::ordered_json WaypointsJson(const trial::TrialResult& result);
nlohmann::ordered_json LimitsJson(const trial::LimitCounts& limits);

/// summary.json of a simulated trial: outcome, times, waypoints, which limits of the controller
/// were binding, seed and version.
std::string SimulationJson(const experiment::Experiment& experiment,
                           const sweep::SimulatedRun& run);

/// Columns t_s,power_left,power_right: every command as it was sent.
std::string CommandsCsv(const trial::TrialResult& result);

}  // namespace rift::report
