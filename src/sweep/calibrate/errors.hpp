#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "rift/sweep/calibrate/calibration.hpp"

namespace rift::sweep {

/// Traits of a path that a like simulator shares, each on a scale where differences are even.
enum Trait { kLogWeave, kLogSpeed, kLoopDelay_s, kSteeringGain, kTraits };
using Traits = std::optional<Eigen::Vector4d>;

/// An error in standard deviations whose square is Huber's loss (1964): itself up to `outlier`,
/// beyond it a loss that grows in proportion.
double Huber(double error, double outlier);

/// Over those that tell them; none when none does.
Traits MeanTraits(const std::vector<Traits>& of_runs);

class FittedSimulator;

/// What is known of the logs before anything is simulated.
struct LoggedTraits {
  std::vector<Traits> of_log;
  Eigen::Vector4d scatter;         ///< standard deviation of each trait among the logs; 1: unknown
  std::vector<int> partner;        ///< an earlier log of the same setting; -1: none
  std::vector<double> log_spread;  ///< logarithm of the gap to the partner; NaN without one
  double spread_scatter = 1.0;
};

LoggedTraits TraitsOfLogs(const std::vector<CalibrationLog>& logs, const FittedSimulator& simulator,
                          const std::vector<double>& values);

/// Errors of a log at one set of values: first the motions (three channels each, in their units;
/// see FittedSimulator), then one for each trait and the spread, over their scatter.
struct LogErrors {
  Eigen::VectorXd motions;
  Eigen::VectorXd traits;
  std::vector<int> frames;  ///< of each three motions
};

std::vector<LogErrors> ErrorsAt(const std::vector<CalibrationLog>& logs, const LoggedTraits& traits,
                                FittedSimulator& simulator, const std::vector<double>& values,
                                const CalibrationOptions& options);

/// The scatter that makes each kind of motion error over all logs likeliest, (frames - 1) x 3:
/// normal errors, outliers in proportion; 1 where there are none.
Eigen::MatrixXd ScaleOf(const std::vector<LogErrors>& errors, const CalibrationOptions& options);

/// All errors of a log over their scale and weight: the sum of squares is its share of the loss.
Eigen::VectorXd Weighted(const LogErrors& errors, const Eigen::MatrixXd& scale,
                         const CalibrationOptions& options);

/// -2 log of the likelihood of all errors at the scatter that makes them likeliest, but for a
/// constant. A loss over a scatter that is taken where it stands can be lowered by errors that
/// grow.
double Deviance(const std::vector<LogErrors>& errors, const CalibrationOptions& options);

/// The slope of Weighted at `errors`, where these change with `slope`.
Eigen::VectorXd WeightedSlope(const LogErrors& errors, const LogErrors& slope,
                              const Eigen::MatrixXd& scale, const CalibrationOptions& options);

}  // namespace rift::sweep
