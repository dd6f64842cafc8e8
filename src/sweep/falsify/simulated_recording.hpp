#pragma once

#include "rift/sweep/falsify/recorded_logs.hpp"
#include "rift/sweep/falsify/simulated_trial.hpp"

namespace rift::sweep {

/// How a trial ended, as a row of a sweep says it.
TrialStatus StatusOf(trial::Outcome outcome);

/// A finished run as a sweep takes it: its log, its stamps put back on frames of `grid_fps` (0:
/// left as they are), or why it is no trajectory to be compared.
Recording RecordingOf(SimulatedRun run, const SimulatedTrial& trial, double grid_fps = 0.0);

}  // namespace rift::sweep
