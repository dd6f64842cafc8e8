#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "rift/experiment/experiment.hpp"
#include "rift/sweep/falsify/result.hpp"
#include "rift/sweep/falsify/trial_runner.hpp"

namespace rift::sweep {

/// Seed of a setting's first trial, the next has the next; nothing where the candidates are logs.
std::optional<std::uint64_t> FirstSeed(const experiment::Experiment& experiment);

/// All trials of a setting. Every setting meets the same random numbers (common random numbers);
/// `repeat` > 0 asks for further trials of the same kind with seeds of their own.
std::vector<TrialRequest> TrialsAt(const experiment::Experiment& experiment,
                                   const experiment::Theta& theta, int repeat = 0);

/// A result without rows, its head filled in from the experiment.
SweepResult EmptyResult(const experiment::Experiment& experiment);

/// Runs every trial of every setting. Nothing when it was told to stop.
std::optional<SweepResult> SweepGrid(const experiment::Experiment& experiment,
                                     const RunTrials& run);

}  // namespace rift::sweep
