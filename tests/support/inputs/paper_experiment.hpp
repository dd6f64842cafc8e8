#pragma once

#include "rift/experiment/experiment.hpp"
#include "support/inputs/paper_waypoints.hpp"

namespace rift::test {

/// The task of the paper with a command for each new pose, as a bench without a clock of its own
/// drives it.
inline experiment::Experiment PaperExperiment() {
  experiment::Experiment experiment;
  experiment.name = "bench";
  experiment.waypoints = PaperWaypoints();
  experiment.trial.pace = trial::Pace::kNewPose;
  return experiment;
}

}  // namespace rift::test
