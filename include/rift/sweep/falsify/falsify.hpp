#pragma once

#include <optional>
#include <span>
#include <vector>

#include "rift/experiment/experiment.hpp"
#include "rift/sweep/falsify/options.hpp"
#include "rift/sweep/falsify/search_loop.hpp"

namespace rift::sweep {

/// What the repeats of a setting say at a stated confidence: falsified when the Clopper-Pearson
/// interval for the share of such trials that fail lies above `share`, not falsified when it lies
/// below; in between, and without a trial that tells, undecided.
gap::Verdict JudgeSetting(std::span<const TrialRow> rows, const FalsifyOptions& options);

/// How many trials of a setting, all of them failing, it takes to falsify it; infinite for a share
/// of 1.
double TrialsToFalsify(const FalsifyOptions& options);

/// Threshold minus mean gap: below zero is a failure. A fall that counts is as bad as twice the
/// threshold. NaN when no row tells.
double Robustness_m(std::span<const TrialRow> rows, double threshold_m);

/// Looks for settings whose gap exceeds the threshold. Those that fail or come near it are
/// repeated. The result depends on the experiment alone. Nothing when it was told to stop. Throws
/// std::invalid_argument for a space without parameters or candidates that are logs.
std::optional<SweepResult> Falsify(const experiment::Experiment& experiment, const RunTrials& run,
                                   const MayStart& may_start);

}  // namespace rift::sweep
