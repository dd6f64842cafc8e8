#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "rift/sweep/falsify/result.hpp"
#include "rift/sweep/falsify/trial_runner.hpp"
#include "rift/trajectory/trajectory.hpp"

namespace rift::sweep {

/// A trajectory as a sweep gets it, or why there is none.
struct Recording {
  TrialStatus status = TrialStatus::kOk;
  std::string reason;
  std::string source;  ///< a file, or what made it
  trajectory::Trajectory trajectory;
  std::optional<trial::LimitCounts> limits{};  ///< what its controller asked for, where known
};

/// Brings the reference trajectory of a trial.
using Reference = std::function<Recording(const TrialRequest&)>;

/// Brings the candidate trajectory, which may start where the reference did.
using Candidate = std::function<Recording(const TrialRequest&, const Recording& reference)>;

/// How far the reference trajectories of a setting are apart: gap::NoiseFloor_m.
using NoiseFloor = std::function<double(const experiment::Theta& theta)>;

/// What a sweep over a grid compares.
struct GridPlan {
  std::string name;
  std::string candidate_kind;
  std::string reference_kind;
  std::vector<experiment::Parameter> parameters;  ///< grid axes
  std::vector<std::string> trials;                ///< repeats of each setting
  std::optional<std::uint64_t> seed;  ///< of the first trial, the next has the next; none for logs
  gap::GapOptions gap;
  double tag_offset_m = 0.0;  ///< already in the references; for the record
  bool falls_count = false;   ///< a trial in which the robot fell is falsified
};

/// One trial: its candidate against its reference. Without one of them it is a row with its status.
TrialRow CompareTrial(const GridPlan& plan, const TrialRequest& request, const Candidate& candidate,
                      const Reference& reference);

/// All trials of a setting. Every setting meets the same random numbers (common random numbers);
/// `repeat` > 0 asks for further trials of the same kind with seeds of their own.
std::vector<TrialRequest> TrialsAt(const GridPlan& plan, const experiment::Theta& theta,
                                   int repeat = 0);

/// Runs every trial of every setting. Nothing when it was told to stop.
std::optional<SweepResult> SweepGrid(const GridPlan& plan, const RunTrials& run,
                                     const NoiseFloor& noise_floor_m);

/// A result without rows, its head filled in from the plan.
SweepResult EmptyResult(const GridPlan& plan);
/// Fills in all that follows from the rows.
void Conclude(SweepResult& result, const NoiseFloor& noise_floor_m);

/// Logs named by path templates over the parameters and {trial}.
struct LogPaths {
  std::string candidate;
  std::string reference;
};

/// Throws std::invalid_argument when a path names no parameter, or a parameter or the trials are
/// named by no path: the same rows would stand there under several labels.
void CheckPaths(const GridPlan& plan, const LogPaths& paths);

}  // namespace rift::sweep
