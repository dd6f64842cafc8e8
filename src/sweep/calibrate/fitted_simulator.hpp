#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "errors.hpp"
#include "rift/sweep/calibrate/calibration.hpp"
#include "rift/sweep/calibrate/identification.hpp"
#include "rift/sweep/falsify/candidate_runs.hpp"

namespace rift::sweep {

/// What a simulator tells of one log at one set of values.
struct LogPrediction {
  /// Three channels for each comparison (see the simulator), in their units, and its kind: 1 and
  /// on, each of which has a scale of its own.
  Eigen::VectorXd motions;
  std::vector<int> frames;
  Traits mean_traits;                        ///< of the runs that tell them
  std::vector<trajectory::Trajectory> runs;  ///< whole ones, that reached the end
};

/// A simulator as a fit sees it: rift's own or somebody else's program. Logs are known by their
/// place in the list that is fitted; the same values and seeds give the same predictions.
class FittedSimulator {
 public:
  virtual ~FittedSimulator() = default;

  /// One prediction for each log.
  virtual std::vector<LogPrediction> Predict(const std::vector<CalibrationLog>& logs,
                                             const std::vector<double>& values,
                                             const CalibrationOptions& options) = 0;
  /// A run in the place of each log, with noise of its own for each repeat (from 0), that arrives
  /// and is no longer than the log allows (see RunWithin).
  virtual std::vector<trajectory::Trajectory> LogsAt(const std::vector<CalibrationLog>& logs,
                                                     const std::vector<double>& values,
                                                     int repeat) = 0;
  /// Of a path driven in the place of a log; none for one too short to tell them.
  virtual Traits TraitsOf(const trajectory::Trajectory& path, size_t log,
                          const std::vector<double>& values) const = 0;
  /// Motions and traits come of the same whole runs, and so do their slopes.
  virtual bool HasWholeRunsOnly() const = 0;
};

/// rift's own simulator; `threads` evaluate logs at once and change no result. `twin` must outlive
/// it.
class SimulatedTwins : public FittedSimulator {
 public:
  SimulatedTwins(const TwinAt& twin, int threads) : twin_(twin), threads_(threads) {}

  /// Short-horizon errors: ahead, left, turned; in order of rows and frames.
  std::vector<LogPrediction> Predict(const std::vector<CalibrationLog>& logs,
                                     const std::vector<double>& values,
                                     const CalibrationOptions& options) override;
  std::vector<trajectory::Trajectory> LogsAt(const std::vector<CalibrationLog>& logs,
                                             const std::vector<double>& values,
                                             int repeat) override;
  Traits TraitsOf(const trajectory::Trajectory& path, size_t log,
                  const std::vector<double>& values) const override;
  bool HasWholeRunsOnly() const override { return false; }

 private:
  const TwinAt& twin_;
  int threads_;
};

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
  void SayDoubts(const Recording& run, const CalibrationLog& log) const;

  CandidateRuns& runs_;
  std::vector<TrialRequest> requests_;
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

/// As the public one, of any simulator.
Calibration Calibrate(const std::vector<experiment::FreeParameter>& parameters,
                      const std::vector<CalibrationLog>& logs, FittedSimulator& simulator,
                      const CalibrationOptions& options, std::mt19937_64& generator,
                      const CalibrationStep& on_step, const IsAllowed& is_allowed = {});

}  // namespace rift::sweep
