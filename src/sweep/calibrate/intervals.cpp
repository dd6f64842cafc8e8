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

/// How many logs a draw holds.
struct Counts {
  size_t real = 0, simulated = 0;
};

/// A gradient of the prior. What it is known by could have come out otherwise, as the logs could: a
/// parameter that no log tells scatters as its prior does.
Eigen::VectorXd DrawnPrior(const Eigen::VectorXd& weight, std::mt19937_64& generator) {
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(weight.size());
  for (Eigen::Index k = 0; k < weight.size(); ++k) {
    if (weight[k] == 0.0) continue;
    const double share = (static_cast<double>(generator() >> 11) + 0.5) * 0x1p-53;
    gradient[k] = std::sqrt(weight[k]) * statistics::NormalQuantile(share);
  }
  return gradient;
}

/// Estimates about that of the fit, one row each, from as many logs drawn anew out of `real`, the
/// simulated logs that a correction came from drawn anew out of `simulated` as well. Gradients
/// alone are drawn, and every draw has the Hessian of all logs (score bootstrap: Kline and Santos
/// 2012): of a parameter that few logs tell some draws hold none of them, and would say anything.
Eigen::MatrixXd Draws(const Counts& counts, const Pool& real, const Pool& simulated,
                      const Eigen::VectorXd& prior_weight, int resamples,
                      std::mt19937_64& generator) {
  const auto logs = static_cast<double>(counts.real);
  Eigen::MatrixXd hessian = logs / static_cast<double>(real.hessians.size()) * Sum(real.hessians);
  hessian.diagonal() += prior_weight;
  hessian.diagonal().array() += RidgeOf(hessian);
  const auto solver = hessian.ldlt();
  Eigen::MatrixXd draws(resamples, prior_weight.size());
  for (Eigen::Index row = 0; row < draws.rows(); ++row) {
    Eigen::VectorXd gradient = DrawnPrior(prior_weight, generator);
    for (size_t i = 0; i < counts.real; ++i) {
      gradient += real.scatter[generator() % real.scatter.size()];
    }
    for (size_t i = 0; i < counts.simulated; ++i) {
      gradient -= logs / static_cast<double>(counts.simulated) *
                  simulated.scatter[generator() % simulated.scatter.size()];
    }
    draws.row(row) = -solver.solve(gradient);
  }
  return draws;
}

/// How far estimates scatter, and how together.
struct Scatter {
  Eigen::VectorXd reach;  ///< half the width of the central draws
  Eigen::MatrixXd correlation;
};

Scatter ScatterOf(const Eigen::MatrixXd& draws, double confidence) {
  Scatter scatter{.reach = Eigen::VectorXd(draws.cols())};
  for (Eigen::Index k = 0; k < draws.cols(); ++k) {
    const auto [low, high] =
        statistics::CentralInterval({draws.col(k).begin(), draws.col(k).end()}, confidence);
    scatter.reach[k] = 0.5 * (high - low);
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
                  const Eigen::VectorXd& prior_weight, const CalibrationOptions& options,
                  std::mt19937_64& generator) {
  Counts counts{.real = at.gradients.size()};
  if (!simulated.empty()) counts.simulated = simulated.back().gradients.size();
  const auto from = [&](const Pool& real, const Pool& made) {
    return ScatterOf(Draws(counts, real, made, prior_weight, options.resamples, generator),
                     options.confidence);
  };
  Pool real;
  real.Add(at);
  if (simulated.empty()) return from(real, Pool{});
  Pool made, all = real;
  made.Add(simulated.back());
  for (const Linearised& set : simulated) all.Add(set);
  const Scatter apart = from(real, made);
  Scatter together = from(all, all);
  together.reach = together.reach.cwiseMax(apart.reach);
  return together;
}

/// Of the scatter of each parameter (Satterthwaite; Bell and McCaffrey 2002). Few logs tell their
/// own scatter badly, and those of a parameter are fewer where some tell little of it; how far a
/// prior scatters is known.
Eigen::VectorXd DegreesOfFreedom(const Linearised& at, const Eigen::VectorXd& prior_weight) {
  Eigen::MatrixXd hessian = Sum(at.hessians);
  hessian.diagonal() += prior_weight;
  hessian.diagonal().array() += RidgeOf(hessian);
  const Eigen::MatrixXd inverse =
      hessian.ldlt().solve(Eigen::MatrixXd::Identity(hessian.rows(), hessian.cols()));
  const auto variance = [&](const Eigen::MatrixXd& told) -> Eigen::VectorXd {
    return (inverse * told * inverse).diagonal();
  };
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(prior_weight.size()), squares = sum;
  for (const Eigen::MatrixXd& log : at.hessians) {
    const Eigen::VectorXd of_log = variance(log);
    sum += of_log;
    squares += of_log.cwiseAbs2();
  }
  const Eigen::VectorXd all = sum + variance(prior_weight.asDiagonal());
  constexpr double kMany = 1e6;  // no log tells it: the normal distribution
  Eigen::VectorXd degrees = Eigen::VectorXd::Constant(prior_weight.size(), kMany);
  for (Eigen::Index k = 0; k < degrees.size(); ++k) {
    if (sum[k] <= 0.0) continue;
    const double of_logs = std::max(1.0, sum[k] * sum[k] / squares[k] - 1.0);
    degrees[k] = std::min(kMany, of_logs * std::pow(all[k] / sum[k], 2));
  }
  return degrees;
}

}  // namespace

void Judge(const std::vector<experiment::FreeParameter>& parameters,
           const CalibrationOptions& options, const Eigen::VectorXd& estimate, const Linearised& at,
           const std::vector<Linearised>& simulated, const Prior& prior, std::mt19937_64& generator,
           Calibration& result) {
  const Scatter scatter = ScatterOf(at, simulated, prior.weight, options, generator);
  const Eigen::VectorXd degrees = DegreesOfFreedom(at, prior.weight);
  const double upper = 0.5 + 0.5 * options.confidence;
  const std::vector<double> values = ValuesAt(parameters, estimate);
  const Eigen::Index n = estimate.size();
  std::vector<bool> has_effect;
  for (Eigen::Index k = 0; k < n; ++k) {
    const experiment::FreeParameter& p = parameters[static_cast<size_t>(k)];
    const double value = values[static_cast<size_t>(k)];
    const double reach = scatter.reach[k] * statistics::StudentQuantile(degrees[k], upper) /
                         statistics::NormalQuantile(upper);
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
