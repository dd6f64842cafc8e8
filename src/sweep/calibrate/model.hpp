#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <vector>

#include "errors.hpp"
#include "rift/sweep/calibrate/calibration.hpp"

namespace rift::sweep {

/// Where a fit may go, in shares of the ranges: in [0, 1], and no rule between keys is broken.
class Domain {
 public:
  using Contained = std::function<bool(const Eigen::VectorXd& shares)>;

  /// Without a question to ask all of [0, 1]. `start` stands for the middle of a domain so small
  /// that chance does not meet it.
  explicit Domain(Contained contained = {}, const Eigen::VectorXd& start = {});

  bool Contains(const Eigen::VectorXd& shares) const { return !contained_ || contained_(shares); }
  /// The shares themselves, or where the way to them from the middle of the domain leaves it.
  Eigen::VectorXd Nearest(const Eigen::VectorXd& shares) const;

 private:
  Contained contained_;
  Eigen::VectorXd middle_;
};

/// Values as shares of their ranges, which makes steps and damping mean the same for each.
std::vector<double> ValuesAt(const std::vector<experiment::FreeParameter>& parameters,
                             const Eigen::VectorXd& shares);

constexpr std::uint64_t kSeedsOfLog = 100'000;  ///< between the first seeds of two logs of a fit

/// Of a run that stands for a real log, whose own runs count up from `first`: another one for each
/// repeat and try, both from 0, and of no other log's, of up to 2000. Below 2^31, which any program
/// takes, up to repeat 39.
std::uint64_t SeedInPlace(std::uint64_t first, int repeat, int attempt);

constexpr int kMostTries = 10;  ///< of a run in the place of a log, to arrive on no detour

/// A run of the twin in the place of a log that arrives and is no longer than that by strides: that
/// of the first try, else of one of the next nine; without any such run the last of them.
trajectory::Trajectory RunWithin(double longest_m, SimulatedTrial twin, int repeat);

/// What is known of the parameters beside the logs: independent normal distributions, in shares of
/// the ranges.
struct Prior {
  Eigen::VectorXd mean;
  Eigen::VectorXd weight;  ///< 1 / sd^2; 0: nothing is known

  double LossAt(const Eigen::VectorXd& shares) const {
    return weight.dot((shares - mean).cwiseAbs2());
  }
  Eigen::VectorXd GradientAt(const Eigen::VectorXd& shares) const {
    return weight.cwiseProduct(shares - mean);
  }
  Eigen::MatrixXd Hessian() const { return weight.asDiagonal(); }
};
Prior PriorOf(const std::vector<experiment::FreeParameter>& parameters);

using Blocks = std::vector<Eigen::VectorXd>;  ///< weighted errors of each log

double SquaredSum(const Blocks& blocks);
size_t Count(const Blocks& blocks);

/// Of at least one part.
template <class T>
T Sum(const std::vector<T>& parts) {
  T sum = parts.front();
  for (size_t i = 1; i < parts.size(); ++i) sum += parts[i];
  return sum;
}

/// Weighted errors at some shares, and their slopes summed up log by log.
struct Linearised {
  Blocks errors;
  std::vector<Eigen::MatrixXd> hessians;   ///< of each log: transposed slopes times slopes
  std::vector<Eigen::VectorXd> gradients;  ///< of each log: transposed slopes times errors
};

/// What is added to the diagonal of a Hessian to keep parameters without effect where they are.
double RidgeOf(const Eigen::MatrixXd& hessian);

/// A damped Gauss-Newton step from `at` that leaves alone what a bound stops.
Eigen::VectorXd StepWithin(const Eigen::VectorXd& at, const Eigen::VectorXd& low,
                           const Eigen::VectorXd& high, const Eigen::MatrixXd& hessian,
                           const Eigen::VectorXd& gradient, double damping);

/// Errors of a set of logs as a function of the shares.
class ErrorModel {
 public:
  /// `parameters`, `simulator` and `options` must outlive the model.
  ErrorModel(const std::vector<experiment::FreeParameter>& parameters,
             std::vector<CalibrationLog> logs, FittedSimulator& simulator,
             const CalibrationOptions& options, const Eigen::VectorXd& start,
             Domain domain = Domain());

  /// Logs that the simulator made, held against what it predicts for them as the real ones are:
  /// traits are told in the scatter of the real logs.
  ErrorModel OfSimulatedLogs(const Eigen::VectorXd& shares, int repeat) const;

  std::vector<LogErrors> RawErrorsAt(const Eigen::VectorXd& shares);
  Blocks ErrorsAt(const Eigen::VectorXd& shares, const Eigen::MatrixXd& scale);
  /// Slopes over `step` to either side, to one alone where the other is not in the domain, of a
  /// run's traits over a wide one; `raw`: RawErrorsAt(shares).
  Linearised LinearisedAt(const Eigen::VectorXd& shares, const std::vector<LogErrors>& raw,
                          const Eigen::MatrixXd& scale, double step);

  size_t LogCount() const { return logs_.size(); }
  size_t TrialsSimulated() const { return trials_simulated_; }

 private:
  std::vector<LogErrors> Errors(const Eigen::VectorXd& shares, const CalibrationOptions& options);
  Blocks WeightedBlocks(const std::vector<LogErrors>& raw, const Eigen::MatrixXd& scale) const;
  Blocks WeightedAt(const Eigen::VectorXd& shares, const Eigen::MatrixXd& scale,
                    const CalibrationOptions& options);
  Blocks Slope(const Eigen::VectorXd& shares, const std::vector<LogErrors>& raw,
               const Eigen::MatrixXd& scale, Eigen::Index parameter, double step,
               const CalibrationOptions& options);

  const std::vector<experiment::FreeParameter>& parameters_;
  std::vector<CalibrationLog> logs_;
  FittedSimulator& simulator_;
  const CalibrationOptions& options_;
  Domain domain_;
  LoggedTraits traits_;
  size_t trials_simulated_ = 0;
};

}  // namespace rift::sweep
