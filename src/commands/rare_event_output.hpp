#pragma once

#include <filesystem>
#include <string>

#include "further_trials.hpp"
#include "rift/sweep/explain/failure_probability.hpp"

namespace rift::commands {

/// Estimates how often a setting drawn evenly from the space fails, where that is too seldom for
/// plain draws. A setting fails when any of its trials does. Writes DIR/rare_event.json and returns
/// what a person wants to know.
std::string RareEventInto(const std::filesystem::path& folder,
                          const experiment::Experiment& experiment,
                          const sweep::RareEventOptions& options, FurtherTrials& trials);

}  // namespace rift::commands
