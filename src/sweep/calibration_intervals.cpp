#include "calibration_intervals.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <limits>

namespace rift::sweep {
namespace {

/// How far estimates from logs drawn anew with replacement lie from the point of linearisation,
/// one row each. The simulated logs that a correction came from are drawn anew as well.
Eigen::MatrixXd Draws(const Linearised& at, const std::vector<Eigen::VectorXd>& simulated,
                      int resamples, std::mt19937_64& generator) {
  const size_t logs = at.gradients.size();
  const Eigen::Index n = at.gradients.front().size();
  Eigen::MatrixXd draws(resamples, n);
  for (Eigen::Index row = 0; row < draws.rows(); ++row) {
    Eigen::MatrixXd hessian = Eigen::MatrixXd::Zero(n, n);
    Eigen::VectorXd gradient = Eigen::VectorXd::Zero(n);
    for (size_t i = 0; i < logs; ++i) {
      const size_t drawn = generator() % logs;
      hessian += at.hessians[drawn];
      gradient += at.gradients[drawn];
    }
    const double share = static_cast<double>(logs) / static_cast<double>(simulated.size());
    for (size_t i = 0; i < simulated.size(); ++i) {
      gradient -= share * simulated[generator() % simulated.size()];
    }
    hessian.diagonal().array() += RidgeOf(hessian);
    draws.row(row) = -hessian.ldlt().solve(gradient);
  }
  return draws;
}

Eigen::MatrixXd Covariance(const Eigen::MatrixXd& draws, double logs) {
  const Eigen::RowVectorXd mean = draws.colwise().mean();
  const Eigen::MatrixXd centred = draws.rowwise() - mean;
  // A sample of n varies less about its own mean than about the truth.
  const double small_sample = logs > 1.0 ? logs / (logs - 1.0) : 1.0;
  return small_sample * centred.transpose() * centred / static_cast<double>(draws.rows() - 1);
}

}  // namespace

void Judge(const std::vector<FreeParameter>& parameters, const CalibrationOptions& options,
           const Eigen::VectorXd& estimate, const Linearised& at,
           const std::vector<Eigen::VectorXd>& simulated, std::mt19937_64& generator,
           Calibration& result) {
  const auto logs = static_cast<double>(at.gradients.size());
  const Eigen::MatrixXd covariance =
      Covariance(Draws(at, simulated, options.resamples, generator), logs);
  const double quantile = boost::math::quantile(boost::math::students_t(std::max(1.0, logs - 1.0)),
                                                0.5 + 0.5 * options.confidence);
  const std::vector<double> values = ValuesAt(parameters, estimate);
  const Eigen::Index n = estimate.size();
  std::vector<bool> has_effect;
  for (Eigen::Index k = 0; k < n; ++k) {
    const FreeParameter& p = parameters[static_cast<size_t>(k)];
    const double value = values[static_cast<size_t>(k)];
    const double reach = quantile * std::sqrt(covariance(k, k));
    double effect = 0.0;
    for (const Eigen::MatrixXd& hessian : at.hessians) effect += hessian(k, k);
    has_effect.push_back(effect > 0.0);
    CalibratedParameter one{.parameter = p, .value = value, .low = p.min, .high = p.max};
    one.has_effect = has_effect.back();
    if (one.has_effect) {
      one.low = std::max(p.min, value - reach * (p.max - p.min));
      one.high = std::min(p.max, value + reach * (p.max - p.min));
    }
    // The steps of the fit end at a bound only when they would have gone on beyond.
    one.is_at_bound = one.has_effect && (estimate[k] <= 0.0 || estimate[k] >= 1.0);
    one.is_identified = one.has_effect && reach <= options.identified_share;
    result.parameters.push_back(one);
  }
  result.correlation = Eigen::MatrixXd::Constant(n, n, std::numeric_limits<double>::quiet_NaN());
  for (Eigen::Index a = 0; a < n; ++a) {
    for (Eigen::Index b = 0; b < n; ++b) {
      if (!has_effect[static_cast<size_t>(a)] || !has_effect[static_cast<size_t>(b)]) continue;
      result.correlation(a, b) = covariance(a, b) / std::sqrt(covariance(a, a) * covariance(b, b));
    }
  }
}

}  // namespace rift::sweep
