#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "fitted_simulator.hpp"
#include "rift/sweep/calibrate/identification.hpp"
#include "rift/sweep/falsify/candidate_runs.hpp"

namespace rift::sweep {

/// Somebody else's simulator as a fit sees it: whole runs, with seeds of their own for each log.
/// Nobody can tell it what the robot was told in a log, so that its next frames, its loop delay and
/// its steering gain are not to be had. What is had: closeness, the mean run against the log at
/// equal shares of the path's length, in place and in time; and of the likeness weave, speed and
/// spread.
class ProgramTwins : public FittedSimulator {
 public:
  /// `requests` are runs in the place of each log at its setting of the space, with the first of
  /// their seeds. `runs` and `experiment` must outlive it; `experiment_file` is for messages,
  /// `say` told what makes the first run and its log doubtful.
  ProgramTwins(CandidateRuns& runs, std::vector<TrialRequest> requests,
               const experiment::Experiment& experiment, std::string experiment_file, Say say);

  /// Channels: x and y in m, in the frame of the logs, and the time since the first point in s; all
  /// of one kind. Of a log that no run gives a path for: those of a robot that stays where it is.
  /// Throws std::invalid_argument with the reason when the first runs of all give no path at all.
  std::vector<LogPrediction> Predict(const std::vector<CalibrationLog>& logs,
                                     const std::vector<double>& values,
                                     const CalibrationOptions& options) override;
  /// Throws std::runtime_error when ten seeds give no path.
  std::vector<trajectory::Trajectory> LogsAt(const std::vector<CalibrationLog>& logs,
                                             const std::vector<double>& values,
                                             int repeat) override;
  Traits TraitsOf(const trajectory::Trajectory& path, size_t log,
                  const std::vector<double>& values) const override;
  bool HasWholeRunsOnly() const override { return true; }

 private:
  TrialRequest RequestOf(size_t log, const std::vector<double>& values, std::uint64_t seed) const;

  CandidateRuns& runs_;
  std::vector<TrialRequest> requests_;
  void SayDoubts(const Recording& run, const CalibrationLog& log) const;

  const experiment::Experiment& experiment_;
  std::string experiment_file_;
  Say say_;
  bool has_run_ = false;
};

/// The options of a fit by whole runs: one scale for all points, no next frames, slopes over 0.3 of
/// the steps that the experiment says.
CalibrationOptions OfWholeRuns(CalibrationOptions options);

/// Whether there is a path to be compared: two poses, and a length that is finite and not zero.
bool HasPath(const Recording& run);

}  // namespace rift::sweep
