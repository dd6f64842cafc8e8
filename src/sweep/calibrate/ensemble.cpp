#include "rift/sweep/calibrate/ensemble.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "rift/statistics/inference.hpp"
#include "rift/statistics/random.hpp"

namespace rift::sweep {
namespace {

constexpr std::uint64_t kDrawStream = 91;
constexpr int kMostDraws = 1000;  // of a row, to meet values that are allowed

/// As a path between two mirrors goes on.
double Folded(double value, double low, double high) {
  const double width = high - low;
  if (!(width > 0.0)) return low;
  const double past = std::fmod(std::fmod(value - low, 2.0 * width) + 2.0 * width, 2.0 * width);
  return low + (past <= width ? past : 2.0 * width - past);
}

/// A matrix whose product with its transpose is `correlation`.
Eigen::MatrixXd RootOf(const Eigen::MatrixXd& correlation) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(correlation);
  return solver.eigenvectors() * solver.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal();
}

class Posterior {
 public:
  Posterior(const Calibration& fit, const std::vector<Eigen::Index>& open, double confidence,
            std::uint64_t seed)
      : fit_(fit),
        open_(open),
        root_(RootOf(fit.correlation(open, open))),
        deviations_(statistics::NormalQuantile(0.5 + 0.5 * confidence)),
        random_(seed, kDrawStream) {}

  /// Of the open parameters, the first of the row's draws that is allowed.
  std::vector<double> Row(int row, const IsAllowed& is_allowed) const {
    for (int attempt = 0; attempt < kMostDraws; ++attempt) {
      const std::vector<double> draw = Draw(row, attempt);
      if (!is_allowed || is_allowed(WithFitted(draw))) return draw;
    }
    std::vector<double> fitted;
    for (const Eigen::Index k : open_) fitted.push_back(Of(k).value);
    return fitted;
  }

 private:
  const CalibratedParameter& Of(Eigen::Index k) const {
    return fit_.parameters[static_cast<size_t>(k)];
  }

  std::vector<double> Draw(int row, int attempt) const {
    Eigen::VectorXd normal(root_.cols());
    for (Eigen::Index k = 0; k < normal.size(); ++k) {
      const auto place = static_cast<std::uint64_t>(attempt * normal.size() + k);
      normal[k] = random_.Normal(static_cast<std::uint64_t>(row), 2 * place);
    }
    const Eigen::VectorXd together = root_ * normal;
    std::vector<double> draw;
    for (size_t k = 0; k < open_.size(); ++k) {
      const CalibratedParameter& one = Of(open_[k]);
      // The interval ends at the range, near a bound to one side alone.
      const double sd = std::max(one.high - one.value, one.value - one.low) / deviations_;
      draw.push_back(Folded(one.value + sd * together[static_cast<Eigen::Index>(k)],
                            one.parameter.min, one.parameter.max));
    }
    return draw;
  }

  /// Of all parameters.
  std::vector<double> WithFitted(const std::vector<double>& draw) const {
    std::vector<double> values;
    for (const CalibratedParameter& one : fit_.parameters) values.push_back(one.value);
    for (size_t k = 0; k < open_.size(); ++k) values[static_cast<size_t>(open_[k])] = draw[k];
    return values;
  }

  const Calibration& fit_;
  const std::vector<Eigen::Index>& open_;
  Eigen::MatrixXd root_;
  double deviations_;
  statistics::CounterRandom random_;
};

}  // namespace

experiment::Ensemble EnsembleOf(const Calibration& fit, double confidence, int draws,
                                std::uint64_t seed, const IsAllowed& is_allowed) {
  std::vector<Eigen::Index> open;
  experiment::Ensemble ensemble;
  for (size_t i = 0; i < fit.parameters.size() && draws > 0; ++i) {
    const CalibratedParameter& one = fit.parameters[i];
    if (!one.has_effect || !(one.is_identified || one.is_from_prior)) continue;
    open.push_back(static_cast<Eigen::Index>(i));
    ensemble.keys.push_back(one.parameter.key);
  }
  if (open.empty()) return {};
  const Posterior posterior(fit, open, confidence, seed);
  for (int row = 0; row < draws; ++row) ensemble.draws.push_back(posterior.Row(row, is_allowed));
  return ensemble;
}

}  // namespace rift::sweep
