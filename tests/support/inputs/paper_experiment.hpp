#pragma once

#include "support/inputs/paper_task.hpp"

namespace rift::test {

/// The task of the paper with a command for each new pose, as a bench without a clock of its own
/// drives it.
inline experiment::Experiment PaperExperiment() {
  experiment::Experiment experiment = PaperTask();
  experiment.name = "bench";
  experiment.trial.pace = trial::Pace::kNewPose;
  return experiment;
}

}  // namespace rift::test
