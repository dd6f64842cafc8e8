#pragma once

#include "rift/experiment/experiment.hpp"
#include "rift/sweep/falsify/recorded_logs.hpp"
#include "rift/sweep/falsify/trial_runner.hpp"

namespace rift::sweep {

/// One candidate against one reference: the gap and whether the trial fails, by it or by how it
/// ended. Without one of them it is a row with its status.
TrialRow CompareTrial(const experiment::Experiment& experiment, const TrialRequest& request,
                      const Recording& candidate, const Recording& reference);

}  // namespace rift::sweep
