#include "intervals.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "rift/statistics/descriptive.hpp"
#include "rift/statistics/inference.hpp"

namespace rift::sweep {
namespace {

/// Logs to draw from with replacement: the gradient of each about the mean of its set.
struct Pool {
  void Add(const Linearised& set) {
    const auto n = static_cast<double>(set.gradients.size());
    const Eigen::VectorXd mean = Sum(set.gradients) / n;
    // A sample of n varies less about its own mean than about the truth.
    const double small_sample = n > 1.0 ? std::sqrt(n / (n - 1.0)) : 1.0;
    for (const Eigen::VectorXd& gradient : set.gradients) {
      scatter.push_back(small_sample * (gradient - mean));
    }
    hessians.insert(hessians.end(), set.hessians.begin(), set.hessians.end());
  }

  std::vector<Eigen::MatrixXd> hessians;
  std::vector<Eigen::VectorXd> scatter;
};

/// A prior where the estimate stands. What it is known by could have come out otherwise, as the
/// logs could: a parameter that no log tells scatters as its prior does.
struct PriorAt {
  Eigen::VectorXd weight, gradient;

  Eigen::VectorXd Drawn(std::mt19937_64& generator) const {
    Eigen::VectorXd scatter = Eigen::VectorXd::Zero(weight.size());
    for (Eigen::Index k = 0; k < weight.size(); ++k) {
      if (weight[k] == 0.0) continue;
      const double share = (static_cast<double>(generator() >> 11) + 0.5) * 0x1p-53;
      scatter[k] = std::sqrt(weight[k]) * statistics::NormalQuantile(share);
    }
    return scatter;
  }
};

/// Estimates from as many logs drawn anew out of `real`, the simulated logs that a correction came
/// from drawn anew out of `simulated` as well; one row each.
Eigen::MatrixXd Draws(const Linearised& at, const Linearised& corrected_by, const Pool& real,
                      const Pool& simulated, const PriorAt& prior, int resamples,
                      std::mt19937_64& generator) {
  const size_t logs = at.gradients.size(), made = corrected_by.gradients.size();
  const Eigen::Index n = at.gradients.front().size();
  const double share = made > 0 ? static_cast<double>(logs) / static_cast<double>(made) : 0.0;
  Eigen::VectorXd mean = Sum(at.gradients);
  if (made > 0) mean -= share * Sum(corrected_by.gradients);
  mean += prior.gradient;
  Eigen::MatrixXd draws(resamples, n);
  for (Eigen::Index row = 0; row < draws.rows(); ++row) {
    Eigen::MatrixXd hessian = prior.weight.asDiagonal();
    Eigen::VectorXd gradient = mean + prior.Drawn(generator);
    for (size_t i = 0; i < logs; ++i) {
      const size_t drawn = generator() % real.hessians.size();
      hessian += real.hessians[drawn];
      gradient += real.scatter[drawn];
    }
    for (size_t i = 0; i < made; ++i) {
      gradient -= share * simulated.scatter[generator() % simulated.scatter.size()];
    }
    hessian.diagonal().array() += RidgeOf(hessian);
    draws.row(row) = -hessian.ldlt().solve(gradient);
  }
  return draws;
}

/// How far estimates scatter, and how together.
struct Scatter {
  Eigen::VectorXd reach;  ///< half the width of the central draws
  Eigen::MatrixXd correlation;
};

/// From the central draws alone: one that happens to hold no log of a surface tells nothing of its
/// friction and may say anything.
Scatter ScatterOf(Eigen::MatrixXd draws, double confidence) {
  Scatter scatter{.reach = Eigen::VectorXd(draws.cols())};
  for (Eigen::Index k = 0; k < draws.cols(); ++k) {
    const std::vector<double> values(draws.col(k).begin(), draws.col(k).end());
    const auto [low, high] = statistics::CentralInterval(values, confidence);
    scatter.reach[k] = 0.5 * (high - low);
    draws.col(k) = draws.col(k).cwiseMax(low).cwiseMin(high);
  }
  const Eigen::MatrixXd centred = draws.rowwise() - draws.colwise().mean();
  const Eigen::MatrixXd covariance = centred.transpose() * centred;
  const Eigen::VectorXd inverse_sd = covariance.diagonal().cwiseSqrt().cwiseInverse();
  scatter.correlation = inverse_sd.asDiagonal() * covariance * inverse_sd.asDiagonal();
  // Rounding differs on the two sides of the diagonal.
  scatter.correlation.triangularView<Eigen::StrictlyUpper>() =
      scatter.correlation.transpose().eval();
  return scatter;
}

/// From the logs alone, and from logs and simulated ones drawn together: a dozen logs often scatter
/// much less than the next dozen would, and simulated ones do not know what the model lacks. The
/// wider of the two, parameter by parameter, with the correlations of the larger pool.
Scatter ScatterOf(const Linearised& at, const std::vector<Linearised>& simulated,
                  const PriorAt& prior, const CalibrationOptions& options,
                  std::mt19937_64& generator) {
  const auto from = [&](const Linearised& by, const Pool& real, const Pool& made) {
    return ScatterOf(Draws(at, by, real, made, prior, options.resamples, generator),
                     options.confidence);
  };
  Pool real;
  real.Add(at);
  if (simulated.empty()) return from(Linearised{}, real, Pool{});
  Pool made, all = real;
  made.Add(simulated.back());
  for (const Linearised& set : simulated) all.Add(set);
  const Scatter apart = from(simulated.back(), real, made);
  Scatter together = from(simulated.back(), all, all);
  together.reach = together.reach.cwiseMax(apart.reach);
  return together;
}

}  // namespace

void Judge(const std::vector<experiment::FreeParameter>& parameters,
           const CalibrationOptions& options, const Eigen::VectorXd& estimate, const Linearised& at,
           const std::vector<Linearised>& simulated, const Prior& prior, std::mt19937_64& generator,
           Calibration& result) {
  const auto logs = static_cast<double>(at.gradients.size());
  const Scatter scatter =
      ScatterOf(at, simulated, {prior.weight, prior.GradientAt(estimate)}, options, generator);
  // Few logs tell their own scatter badly.
  const double upper = 0.5 + 0.5 * options.confidence;
  const double few_logs = statistics::StudentQuantile(std::max(1.0, logs - 1.0), upper) /
                          statistics::NormalQuantile(upper);
  const std::vector<double> values = ValuesAt(parameters, estimate);
  const Eigen::Index n = estimate.size();
  std::vector<bool> has_effect;
  for (Eigen::Index k = 0; k < n; ++k) {
    const experiment::FreeParameter& p = parameters[static_cast<size_t>(k)];
    const double value = values[static_cast<size_t>(k)];
    const double reach = few_logs * scatter.reach[k];
    double effect = 0.0;
    for (const Eigen::MatrixXd& hessian : at.hessians) effect += hessian(k, k);
    has_effect.push_back(effect > 0.0);
    CalibratedParameter one{.parameter = p, .value = value, .low = p.min, .high = p.max};
    one.has_effect = has_effect.back();
    one.is_from_prior = prior.weight[k] > effect;
    if (one.has_effect || one.is_from_prior) {
      one.low = std::max(p.min, value - reach * (p.max - p.min));
      one.high = std::min(p.max, value + reach * (p.max - p.min));
    }
    // The steps of the fit end at a bound only when they would have gone on beyond.
    one.is_at_bound = one.has_effect && (estimate[k] <= 0.0 || estimate[k] >= 1.0);
    one.is_identified = (one.has_effect || one.is_from_prior) && reach <= options.identified_share;
    result.parameters.push_back(one);
  }
  result.correlation = Eigen::MatrixXd::Constant(n, n, std::numeric_limits<double>::quiet_NaN());
  for (Eigen::Index a = 0; a < n; ++a) {
    for (Eigen::Index b = 0; b < n; ++b) {
      if (!has_effect[static_cast<size_t>(a)] || !has_effect[static_cast<size_t>(b)]) continue;
      result.correlation(a, b) = scatter.correlation(a, b);
    }
  }
}

}  // namespace rift::sweep
