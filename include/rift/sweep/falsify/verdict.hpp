#pragma once

#include <span>

#include "rift/sweep/falsify/options.hpp"
#include "rift/sweep/falsify/result.hpp"

namespace rift::sweep {

/// How many of the trials that tell fail, with the interval for the share of all such trials.
gap::RepeatVerdict CountFailures(std::span<const TrialRow> rows, double confidence);

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

}  // namespace rift::sweep
