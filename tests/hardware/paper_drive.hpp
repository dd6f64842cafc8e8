#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bench.hpp"
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

/// Who drives a bench: says yes to the start, and stops it when told to.
struct BenchOperator {
  std::vector<std::string> told;
  std::optional<std::pair<StopReason, std::string>> stop;
  bool says_yes = true;

  DriveParts PartsOf(Bench& bench) {
    return {.line = bench,
            .poses = bench,
            .clock = bench,
            .stoppers = {[this] { return stop; }},
            .say = [this](const std::string& line) { told.push_back(line); },
            .may_arm = [this] { return says_yes; },
            .threads = false};
  }
};

}  // namespace rift::hardware
