#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "rift/trial/trial.hpp"

namespace rift::commands {

/// What the summaries of a simulated and of a real trial have in common.
nlohmann::ordered_json WaypointsJson(const trial::TrialResult& result);
nlohmann::ordered_json LimitsJson(const trial::LimitCounts& limits);

/// Columns t_s,power_left,power_right: every command as it was sent.
std::string CommandsCsv(const trial::TrialResult& result);

}  // namespace rift::commands
