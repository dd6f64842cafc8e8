#pragma once

#include <functional>
#include <string>
#include <vector>

#include "rift/sweep/result.hpp"
#include "rift/trajectory/trajectory.hpp"

namespace rift::sweep {

enum class Side { kCandidate, kReference };

/// A log as the sweep gets it: the trajectory, ready to be compared, or why there is none.
struct LoadedLog {
  TrialStatus status = TrialStatus::kOk;
  std::string reason;
  trajectory::Trajectory trajectory;
};

/// Brings the log at a path; the sweep itself knows no files.
using LogSource = std::function<LoadedLog(const std::string& path, Side side)>;

/// What a sweep over recorded trajectories compares.
struct LogSweepPlan {
  std::string name;
  std::vector<Parameter> parameters;  ///< grid axes
  std::vector<std::string> trials;    ///< repeats of the reference for each setting
  std::string candidate_path;         ///< template over the parameters' names and {trial}
  std::string reference_path;
  gap::GapOptions gap;
};

/// Compares every setting's candidate log with each of its reference logs. A log that is missing
/// or bad is a row with its status. Throws std::invalid_argument when a path names no parameter.
SweepResult CompareLogs(const LogSweepPlan& plan, const LogSource& source);

}  // namespace rift::sweep
