#pragma once

#include "rift/hardware/arming.hpp"
#include "support/inputs/paper_waypoints.hpp"

namespace rift::hardware {

/// The paper's waypoints, a command for each new pose.
inline DriveTask PaperTask() {
  DriveTask task;
  task.task = test::PaperWaypoints();
  task.trial.pace = trial::Pace::kNewPose;
  return task;
}

}  // namespace rift::hardware
