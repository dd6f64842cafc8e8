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

/// A seed beside those that are counted up from the experiment's, short enough to be read.
std::uint64_t FreshSeed(std::uint64_t seed, std::uint64_t stream);

/// Which random numbers the trials of a setting meet.
enum class TrialKind {
  kComparison,  ///< trial i of every setting the same: settings differ by themselves alone
  kRandomDraw,  ///< numbers of its own for each setting: draws are independent of each other
};

/// The first trials of a setting, one for each of reference.trials.
std::vector<TrialRequest> TrialsAt(const experiment::Experiment& experiment,
                                   const experiment::Theta& theta,
                                   TrialKind kind = TrialKind::kComparison);

/// `count` more of the same kind behind its first `before` ones, each with a seed of its own.
std::vector<TrialRequest> FurtherTrials(const experiment::Experiment& experiment,
                                        const experiment::Theta& theta, TrialKind kind, int before,
                                        int count);

/// A result without rows, its head filled in from the experiment.
SweepResult EmptyResult(const experiment::Experiment& experiment);

/// Runs every trial of every setting; with falsify.repeat: every further simulated ones until all
/// settings are decided. Nothing when it was told to stop.
std::optional<SweepResult> SweepGrid(const experiment::Experiment& experiment,
                                     const RunTrials& run);

}  // namespace rift::sweep
