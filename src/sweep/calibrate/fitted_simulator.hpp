#pragma once

#include <cstddef>
#include <vector>

#include "errors.hpp"
#include "rift/sweep/calibrate/calibration.hpp"

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
  /// A run in the place of each log, with noise of its own for each repeat (from 0), no longer than
  /// the log allows (see RunWithin).
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

/// As the public one, of any simulator.
Calibration Calibrate(const std::vector<experiment::FreeParameter>& parameters,
                      const std::vector<CalibrationLog>& logs, FittedSimulator& simulator,
                      const CalibrationOptions& options, std::mt19937_64& generator,
                      const CalibrationStep& on_step);

}  // namespace rift::sweep
