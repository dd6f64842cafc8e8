#pragma once

#include <string>
#include <vector>

#include "rift/experiment/experiment.hpp"
#include "rift/sweep/falsify/recorded_logs.hpp"
#include "rift/sweep/falsify/result.hpp"

namespace rift::sweep {

/// What makes a finished trial doubtful: what was doubted in the logs of its sides when they were
/// read, and, where the sides come from different hands (the reference is logs or a program),
/// gap::Doubts of the two. Both must be ok, and have paths.
std::vector<TrialDoubt> DoubtsOf(const experiment::Experiment& experiment,
                                 const Recording& candidate, const Recording& reference);

/// The same for doubts that differ in their numbers alone.
std::string KindOf(const TrialDoubt& doubt);

/// Whether a sweep is doubted for it when so many of its trials with a gap show it. A doubt about
/// recorded logs counts from the first on; one that depends on a run counts when half of them show
/// it, as a mistake in units or axes does, and a robot that slides sideways does not.
bool CountsAsDoubt(const SweepResult& result, const TrialDoubt& doubt, int trials, int told);

/// What the rows of a sweep are doubted for, each kind once, in the order of their first rows.
std::vector<SweepDoubt> DoubtsOf(const SweepResult& result);

/// The logs of a row that a doubt is about: "SIM a.csv and REAL b.csv", or one of them alone.
std::string SidesText(const TrialRow& row, DoubtAbout about);

/// One line that names the trials, their logs and the doubt.
std::string DoubtText(const SweepResult& result, const SweepDoubt& doubt);

}  // namespace rift::sweep
