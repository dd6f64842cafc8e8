#pragma once

#include "rift/sweep/falsify/recorded_logs.hpp"
#include "rift/sweep/falsify/simulated_trial.hpp"

namespace rift::sweep {

/// How a trial ended, as a row of a sweep says it.
TrialStatus StatusOf(trial::Outcome outcome);

/// A finished run as a sweep takes it: its log, or why it is no trajectory to be compared.
Recording RecordingOf(SimulatedRun run, const SimulatedTrial& trial);

}  // namespace rift::sweep
