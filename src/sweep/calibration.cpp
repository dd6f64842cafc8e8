#include "rift/sweep/calibration.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "calibration_errors.hpp"

namespace rift::sweep {
namespace {

constexpr double kConverged = 1e-3;  // of the range, for the largest change of a parameter
constexpr double kRidge = 1e-9;      // keeps a parameter without effect where it is
constexpr double kLargestDamping = 1e6;
// Whole runs of a delayed bang-bang loop are chaotic: over a small step the scatter of their
// statistics is many times their slope.
constexpr double kWiderForRuns = 5.0;

/// Values as shares of their ranges, which makes steps and ridge mean the same for each.
class Fit {
 public:
  Fit(const std::vector<FreeParameter>& parameters, const std::vector<CalibrationLog>& logs,
      const TwinAt& twin, const CalibrationOptions& options, int threads)
      : parameters_(parameters), logs_(logs), twin_(twin), options_(options), threads_(threads) {
    shares_.resize(static_cast<Eigen::Index>(parameters.size()));
    for (size_t i = 0; i < parameters.size(); ++i) {
      const FreeParameter& p = parameters[i];
      shares_[static_cast<Eigen::Index>(i)] = (p.start - p.min) / (p.max - p.min);
    }
    traits_ = TraitsOfLogs(logs, twin, ValuesAt(shares_));
  }

  Calibration Run(std::mt19937_64& generator, const CalibrationStep& on_step);

 private:
  using Blocks = std::vector<Eigen::VectorXd>;  ///< weighted errors of each log

  std::vector<double> ValuesAt(const Eigen::VectorXd& shares) const;
  std::vector<LogErrors> Errors(const Eigen::VectorXd& shares, const CalibrationOptions& options);
  Blocks WeightedAt(const Eigen::VectorXd& shares, const CalibrationOptions& options);
  Blocks Slope(Eigen::Index parameter, double step, const CalibrationOptions& options);
  void Linearise();
  bool Descend();
  Eigen::VectorXd StepFor(const Eigen::MatrixXd& hessian, const Eigen::VectorXd& gradient,
                          double damping) const;
  Eigen::MatrixXd Draws(std::mt19937_64& generator) const;
  void Judge(const Eigen::MatrixXd& draws, Calibration& result) const;

  const std::vector<FreeParameter>& parameters_;
  const std::vector<CalibrationLog>& logs_;
  const TwinAt& twin_;
  const CalibrationOptions& options_;
  int threads_;
  LoggedTraits traits_;
  Eigen::VectorXd shares_;
  Eigen::MatrixXd scale_;
  Blocks errors_;                          ///< at shares_
  std::vector<Eigen::MatrixXd> hessians_;  ///< of each log: transposed slopes times slopes
  std::vector<Eigen::VectorXd> gradients_;
  double damping_ = 1e-2;
  double last_change_ = 1.0;
  size_t trials_simulated_ = 0;
};

double SquaredSum(const std::vector<Eigen::VectorXd>& blocks) {
  double sum = 0.0;
  for (const Eigen::VectorXd& block : blocks) sum += block.squaredNorm();
  return sum;
}

size_t Count(const std::vector<Eigen::VectorXd>& blocks) {
  size_t count = 0;
  for (const Eigen::VectorXd& block : blocks) count += static_cast<size_t>(block.size());
  return count;
}

std::vector<double> Fit::ValuesAt(const Eigen::VectorXd& shares) const {
  std::vector<double> values;
  for (size_t i = 0; i < parameters_.size(); ++i) {
    const FreeParameter& p = parameters_[i];
    values.push_back(p.min + shares[static_cast<Eigen::Index>(i)] * (p.max - p.min));
  }
  return values;
}

std::vector<LogErrors> Fit::Errors(const Eigen::VectorXd& shares,
                                   const CalibrationOptions& options) {
  trials_simulated_ += logs_.size() * static_cast<size_t>(options.horizon.phases + options.runs);
  return ErrorsAt(logs_, traits_, twin_, ValuesAt(shares), options, threads_);
}

Fit::Blocks Fit::WeightedAt(const Eigen::VectorXd& shares, const CalibrationOptions& options) {
  Blocks blocks;
  for (const LogErrors& errors : Errors(shares, options)) {
    blocks.push_back(Weighted(errors, scale_, options_));
  }
  return blocks;
}

/// Of every error of each log, by central differences, one-sided at a bound.
Fit::Blocks Fit::Slope(Eigen::Index parameter, double step, const CalibrationOptions& options) {
  Eigen::VectorXd below = shares_, above = shares_;
  below[parameter] = std::max(0.0, shares_[parameter] - step);
  above[parameter] = std::min(1.0, shares_[parameter] + step);
  Blocks slopes = WeightedAt(above, options);
  const Blocks at_below = WeightedAt(below, options);
  for (size_t i = 0; i < slopes.size(); ++i) {
    slopes[i] = (slopes[i] - at_below[i]) / (above[parameter] - below[parameter]);
  }
  return slopes;
}

/// Slopes of the predicted motions over a small step, of the statistics of runs over a wide one,
/// summed up log by log.
void Fit::Linearise() {
  const Eigen::Index n = shares_.size();
  CalibrationOptions motions_only = options_, runs_mostly = options_;
  motions_only.runs = 0;
  runs_mostly.horizon.phases = 1;
  std::vector<Eigen::MatrixXd> slopes;
  for (const Eigen::VectorXd& block : errors_) {
    slopes.push_back(Eigen::MatrixXd::Zero(block.size(), n));
  }
  for (Eigen::Index k = 0; k < n; ++k) {
    const Blocks near = Slope(k, options_.step, motions_only);
    for (size_t i = 0; i < slopes.size(); ++i) slopes[i].col(k) = near[i];
    if (options_.runs == 0) continue;
    const Blocks wide = Slope(k, kWiderForRuns * options_.step, runs_mostly);
    for (size_t i = 0; i < slopes.size(); ++i) {
      slopes[i].col(k).tail(kTraits + 1) = wide[i].tail(kTraits + 1);
    }
  }
  hessians_.clear();
  gradients_.clear();
  for (size_t i = 0; i < slopes.size(); ++i) {
    hessians_.push_back(slopes[i].transpose() * slopes[i]);
    gradients_.push_back(slopes[i].transpose() * errors_[i]);
  }
}

/// A Gauss-Newton step that leaves alone what a bound stops.
Eigen::VectorXd Fit::StepFor(const Eigen::MatrixXd& hessian, const Eigen::VectorXd& gradient,
                             double damping) const {
  Eigen::MatrixXd matrix = hessian;
  matrix.diagonal() *= 1.0 + damping;
  matrix.diagonal().array() += kRidge + kRidge * hessian.diagonal().maxCoeff();
  Eigen::VectorXd slope = gradient;
  for (Eigen::Index k = 0; k < slope.size(); ++k) {
    const bool is_stopped =
        (shares_[k] <= 0.0 && slope[k] > 0.0) || (shares_[k] >= 1.0 && slope[k] < 0.0);
    if (!is_stopped) continue;
    matrix.row(k).setZero();
    matrix.col(k).setZero();
    matrix(k, k) = 1.0;
    slope[k] = 0.0;
  }
  return -matrix.ldlt().solve(slope);
}

/// One step of Levenberg and Marquardt, damped until it helps; false when none does.
bool Fit::Descend() {
  const Eigen::Index n = shares_.size();
  Eigen::MatrixXd hessian = Eigen::MatrixXd::Zero(n, n);
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(n);
  for (size_t i = 0; i < hessians_.size(); ++i) {
    hessian += hessians_[i];
    gradient += gradients_[i];
  }
  const double loss = SquaredSum(errors_);
  for (; damping_ < kLargestDamping; damping_ *= 10.0) {
    const Eigen::VectorXd tried =
        (shares_ + StepFor(hessian, gradient, damping_)).cwiseMax(0.0).cwiseMin(1.0);
    last_change_ = (tried - shares_).cwiseAbs().maxCoeff();
    if (last_change_ < kConverged) return false;
    Blocks errors = WeightedAt(tried, options_);
    if (SquaredSum(errors) >= loss) continue;
    shares_ = tried;
    errors_ = std::move(errors);
    damping_ = std::max(1e-4, 0.1 * damping_);
    return true;
  }
  return false;
}

/// Estimates from logs drawn anew with replacement, one row each.
Eigen::MatrixXd Fit::Draws(std::mt19937_64& generator) const {
  const Eigen::Index n = shares_.size();
  Eigen::MatrixXd draws(options_.resamples, n);
  for (Eigen::Index row = 0; row < draws.rows(); ++row) {
    Eigen::MatrixXd hessian = Eigen::MatrixXd::Zero(n, n);
    Eigen::VectorXd gradient = Eigen::VectorXd::Zero(n);
    for (size_t i = 0; i < logs_.size(); ++i) {
      const size_t drawn = generator() % logs_.size();
      hessian += hessians_[drawn];
      gradient += gradients_[drawn];
    }
    hessian.diagonal().array() += kRidge + kRidge * hessian.diagonal().maxCoeff();
    draws.row(row) = shares_ - hessian.ldlt().solve(gradient);
  }
  return draws;
}

void Fit::Judge(const Eigen::MatrixXd& draws, Calibration& result) const {
  const Eigen::RowVectorXd mean = draws.colwise().mean();
  const Eigen::MatrixXd centred = draws.rowwise() - mean;
  const double n = static_cast<double>(logs_.size());
  // A sample of n varies less about its own mean than about the truth.
  const double small_sample = n > 1.0 ? n / (n - 1.0) : 1.0;
  const Eigen::MatrixXd covariance =
      small_sample * centred.transpose() * centred / static_cast<double>(draws.rows() - 1);
  const double quantile = boost::math::quantile(boost::math::students_t(std::max(1.0, n - 1.0)),
                                                0.5 + 0.5 * options_.confidence);
  const std::vector<double> values = ValuesAt(shares_);
  result.correlation = Eigen::MatrixXd::Constant(shares_.size(), shares_.size(),
                                                 std::numeric_limits<double>::quiet_NaN());
  std::vector<bool> has_effect;
  for (Eigen::Index k = 0; k < shares_.size(); ++k) {
    const FreeParameter& p = parameters_[static_cast<size_t>(k)];
    const double reach = quantile * std::sqrt(covariance(k, k));
    double slope = 0.0, effect = 0.0;
    for (size_t i = 0; i < hessians_.size(); ++i) {
      slope += gradients_[i][k];
      effect += hessians_[i](k, k);
    }
    has_effect.push_back(effect > 0.0);
    CalibratedParameter one{.parameter = p, .value = values[static_cast<size_t>(k)]};
    one.has_effect = effect > 0.0;
    one.low = one.has_effect
                  ? std::max(p.min, values[static_cast<size_t>(k)] - reach * (p.max - p.min))
                  : p.min;
    one.high = one.has_effect
                   ? std::min(p.max, values[static_cast<size_t>(k)] + reach * (p.max - p.min))
                   : p.max;
    one.is_at_bound = one.has_effect &&
                      ((shares_[k] <= 0.0 && slope > 0.0) || (shares_[k] >= 1.0 && slope < 0.0));
    one.is_identified = one.has_effect && reach <= options_.identified_share;
    result.parameters.push_back(one);
  }
  for (Eigen::Index a = 0; a < shares_.size(); ++a) {
    for (Eigen::Index b = 0; b < shares_.size(); ++b) {
      if (!has_effect[static_cast<size_t>(a)] || !has_effect[static_cast<size_t>(b)]) continue;
      result.correlation(a, b) = covariance(a, b) / std::sqrt(covariance(a, a) * covariance(b, b));
    }
  }
}

Calibration Fit::Run(std::mt19937_64& generator, const CalibrationStep& on_step) {
  Calibration result;
  const Eigen::VectorXd start = shares_;
  bool goes_on = true;
  while (goes_on && result.steps < options_.iterations) {
    const std::vector<LogErrors> errors = Errors(shares_, options_);
    scale_ = ScaleOf(errors, options_);
    errors_.clear();
    for (const LogErrors& log : errors) errors_.push_back(Weighted(log, scale_, options_));
    Linearise();
    goes_on = Descend();
    result.steps += goes_on;
    if (on_step) {
      on_step(result.steps, SquaredSum(errors_) / static_cast<double>(Count(errors_)));
    }
  }
  result.has_converged = !goes_on;
  if (goes_on) Linearise();  // the last step moved on from where the slopes were taken
  Judge(Draws(generator), result);
  const double count = static_cast<double>(Count(errors_));
  result.loss_after = SquaredSum(errors_) / count;
  result.loss_before = SquaredSum(WeightedAt(start, options_)) / count;
  result.trials_simulated = trials_simulated_;
  return result;
}

void Check(const std::vector<FreeParameter>& parameters, const std::vector<CalibrationLog>& logs) {
  if (parameters.empty()) throw std::invalid_argument("a calibration needs a free parameter");
  if (logs.size() < 2) {
    throw std::invalid_argument(
        fmt::format("a calibration needs at least 2 logs, and there are {}", logs.size()));
  }
  for (const FreeParameter& p : parameters) {
    if (p.min < p.max && p.start >= p.min && p.start <= p.max) continue;
    throw std::invalid_argument(fmt::format(
        "{} starts at {}, but it must lie in its range [{}, {}]", p.key, p.start, p.min, p.max));
  }
}

}  // namespace

Calibration Calibrate(const std::vector<FreeParameter>& parameters,
                      const std::vector<CalibrationLog>& logs, const TwinAt& twin,
                      const CalibrationOptions& options, std::mt19937_64& generator, int threads,
                      const CalibrationStep& on_step) {
  Check(parameters, logs);
  return Fit(parameters, logs, twin, options, threads).Run(generator, on_step);
}

}  // namespace rift::sweep
