#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "rift/sweep/result.hpp"
#include "rift/trajectory/trajectory.hpp"

namespace rift::sweep {

using Theta = std::vector<ParameterValue>;

/// A trajectory as a sweep gets it, or why there is none.
struct Recording {
  TrialStatus status = TrialStatus::kOk;
  std::string reason;
  std::string source;  ///< a file, or what made it
  trajectory::Trajectory trajectory;
  std::optional<trial::LimitCounts> limits{};  ///< what its controller asked for, where known
};

/// Brings the reference trajectory of one trial of one setting.
using Reference = std::function<Recording(const Theta& theta, const std::string& trial)>;

/// Brings the candidate trajectory, which may start where the reference did.
using Candidate = std::function<Recording(const Theta& theta, const std::string& trial,
                                          const Recording& reference)>;

/// What a sweep over a grid compares.
struct GridPlan {
  std::string name;
  std::string candidate_kind;
  std::string reference_kind;
  std::vector<Parameter> parameters;  ///< grid axes
  std::vector<std::string> trials;    ///< repeats of each setting
  gap::GapOptions gap;
  double tag_offset_m = 0.0;  ///< already in the references; for the record
};

/// Compares candidate and reference in every trial of every setting. A trial without one of them is
/// a row with its status.
SweepResult CompareGrid(const GridPlan& plan, const Candidate& candidate,
                        const Reference& reference);

/// Logs named by path templates over the parameters and {trial}.
struct LogPaths {
  std::string candidate;
  std::string reference;
};

/// Throws std::invalid_argument when a path names no parameter, or a parameter or the trials are
/// named by no path: the same rows would stand there under several labels.
void CheckPaths(const GridPlan& plan, const LogPaths& paths);

}  // namespace rift::sweep
