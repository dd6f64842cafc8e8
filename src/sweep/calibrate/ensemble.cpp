#include "rift/sweep/calibrate/ensemble.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "rift/statistics/inference.hpp"
#include "rift/statistics/random.hpp"

namespace rift::sweep {
namespace {

constexpr std::uint64_t kDrawStream = 91;

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

}  // namespace

experiment::Ensemble EnsembleOf(const Calibration& fit, double confidence, int draws,
                                std::uint64_t seed) {
  std::vector<Eigen::Index> open;
  experiment::Ensemble ensemble;
  for (size_t i = 0; i < fit.parameters.size() && draws > 0; ++i) {
    const CalibratedParameter& one = fit.parameters[i];
    if (!one.has_effect || !(one.is_identified || one.is_from_prior)) continue;
    open.push_back(static_cast<Eigen::Index>(i));
    ensemble.keys.push_back(one.parameter.key);
  }
  if (open.empty()) return {};
  const Eigen::MatrixXd root = RootOf(fit.correlation(open, open));
  const double deviations = statistics::NormalQuantile(0.5 + 0.5 * confidence);
  const statistics::CounterRandom random(seed, kDrawStream);
  for (int row = 0; row < draws; ++row) {
    Eigen::VectorXd normal(root.cols());
    for (Eigen::Index k = 0; k < normal.size(); ++k) {
      normal[k] = random.Normal(static_cast<std::uint64_t>(row), 2 * static_cast<std::uint64_t>(k));
    }
    const Eigen::VectorXd together = root * normal;
    std::vector<double>& draw = ensemble.draws.emplace_back();
    for (size_t k = 0; k < open.size(); ++k) {
      const CalibratedParameter& one = fit.parameters[static_cast<size_t>(open[k])];
      // The interval ends at the range, near a bound to one side alone.
      const double sd = std::max(one.high - one.value, one.value - one.low) / deviations;
      draw.push_back(Folded(one.value + sd * together[static_cast<Eigen::Index>(k)],
                            one.parameter.min, one.parameter.max));
    }
  }
  return ensemble;
}

}  // namespace rift::sweep
