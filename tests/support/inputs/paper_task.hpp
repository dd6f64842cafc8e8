#pragma once

#include "rift/experiment/experiment.hpp"
#include "support/inputs/paper_waypoints.hpp"

namespace rift::test {

/// The paper's waypoints in an experiment of defaults.
inline experiment::Experiment PaperTask() {
  experiment::Experiment experiment;
  experiment.name = "paper";
  experiment.waypoints = PaperWaypoints();
  return experiment;
}

}  // namespace rift::test
