#pragma once

#include <optional>

#include "rift/sweep/falsify/evaluator.hpp"
#include "rift/sweep/falsify/falsify.hpp"
#include "rift/sweep/falsify/settings.hpp"

namespace rift::sweep {

/// True if a grid's settings get further trials until they are decided: falsify.repeat is `every`
/// and its trials are simulated.
bool IsRepeatedGrid(const experiment::Experiment& experiment);

/// Runs every trial of every setting; of a repeated grid further ones until all settings are
/// decided. Nothing when it was told to stop.
std::optional<SweepResult> SweepGrid(const experiment::Experiment& experiment,
                                     const RunTrials& run);

/// Visits the grid or searches it, as the experiment's goal says, and judges every setting, its
/// noise floor included. Nothing when it was told to stop. `run` computes the trials with that
/// evaluator; `may_start` ends a search in time; `references` watches what is run before the first
/// trial and after the last. Throws std::logic_error for goal: calibrate, which has no trials to
/// run one by one (sweep/calibrate).
std::optional<SweepResult> Sweep(Evaluator& evaluator, const RunTrials& run,
                                 const MayStart& may_start, const ReferenceWatch& references = {});

}  // namespace rift::sweep
