#pragma once

#include <filesystem>
#include <string>

#include "further_trials.hpp"
#include "rift/sweep/explain/shrink.hpp"

namespace rift::commands {

/// Shrinks a row of the sweep (its id, or "worst") with the random numbers that the row had. Writes
/// DIR/shrunk.json, and DIR/shrunk with the trials that its claims rest on as a table: the row,
/// what it shrank to, and that with each of its changes taken back, for `rift simulate --replay`.
/// Returns what a person wants to know. Throws std::invalid_argument when there is no such row, or
/// it does not fail.
std::string ShrinkInto(const std::filesystem::path& folder,
                       const experiment::Experiment& experiment, const sweep::SweepResult& result,
                       const std::string& row, const sweep::ShrinkOptions& options,
                       FurtherTrials& trials);

}  // namespace rift::commands
