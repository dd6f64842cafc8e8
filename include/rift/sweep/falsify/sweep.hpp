#pragma once

#include <optional>

#include "rift/sweep/falsify/evaluator.hpp"
#include "rift/sweep/falsify/falsify.hpp"
#include "rift/sweep/falsify/settings.hpp"

namespace rift::sweep {

/// Runs every trial of every setting; with falsify.repeat: every further simulated ones until all
/// settings are decided. Nothing when it was told to stop.
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
