#include "logistic.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace rift::statistics {
namespace {

constexpr int kMostSteps = 50;
constexpr double kConverged = 1e-8;  // of the largest change of a weight

/// Each class together weighs as much as the smaller one has observations.
Eigen::VectorXd BalancedWeights(const Eigen::VectorXd& is_first) {
  const double first = is_first.sum(), second = static_cast<double>(is_first.size()) - first;
  const double smaller = std::min(first, second);
  return (is_first.array() * (smaller / first) + (1.0 - is_first.array()) * (smaller / second))
      .matrix();
}

/// Weighted means and standard deviations of what is known of each column.
void Standardise(const Eigen::MatrixXd& features, const Eigen::VectorXd& weights,
                 LogisticModel& model) {
  const Eigen::Index columns = features.cols();
  model.mean = Eigen::VectorXd::Zero(columns);
  model.inverse = Eigen::VectorXd::Zero(columns);
  for (Eigen::Index k = 0; k < columns; ++k) {
    double total = 0.0, sum = 0.0, squares = 0.0;
    for (Eigen::Index i = 0; i < features.rows(); ++i) {
      if (std::isnan(features(i, k))) continue;
      total += weights[i];
      sum += weights[i] * features(i, k);
    }
    if (!(total > 0.0)) continue;
    model.mean[k] = sum / total;
    for (Eigen::Index i = 0; i < features.rows(); ++i) {
      if (std::isnan(features(i, k))) continue;
      squares += weights[i] * std::pow(features(i, k) - model.mean[k], 2);
    }
    const double deviation = std::sqrt(squares / total);
    // Less is rounding of a constant.
    if (deviation > 1e-12 * std::abs(model.mean[k])) model.inverse[k] = 1.0 / deviation;
  }
}

/// With a last column of ones for the intercept.
Eigen::MatrixXd Design(const Eigen::MatrixXd& features, const LogisticModel& model) {
  Eigen::MatrixXd design(features.rows(), features.cols() + 1);
  for (Eigen::Index k = 0; k < features.cols(); ++k) {
    for (Eigen::Index i = 0; i < features.rows(); ++i) {
      const double value = features(i, k);
      design(i, k) = std::isnan(value) ? 0.0 : (value - model.mean[k]) * model.inverse[k];
    }
  }
  design.col(features.cols()).setOnes();
  return design;
}

/// log(1 + e^x) without overflow.
double SoftPlus(double x) { return std::max(x, 0.0) + std::log1p(std::exp(-std::abs(x))); }

double Loss(const Eigen::VectorXd& scores, const Eigen::VectorXd& is_first,
            const Eigen::VectorXd& weights, const Eigen::VectorXd& penalty,
            const Eigen::VectorXd& beta) {
  double loss = 0.5 * penalty.dot(beta.cwiseProduct(beta));
  for (Eigen::Index i = 0; i < scores.size(); ++i) {
    loss += weights[i] * (SoftPlus(scores[i]) - is_first[i] * scores[i]);
  }
  return loss;
}

}  // namespace

Eigen::VectorXd LogisticModel::Scores(const Eigen::MatrixXd& features) const {
  Eigen::VectorXd beta(weights.size() + 1);
  beta << weights, intercept;
  return Design(features, *this) * beta;
}

LogisticModel FitLogistic(const Eigen::MatrixXd& features, const Eigen::VectorXd& is_first,
                          double ridge) {
  LogisticModel model;
  const Eigen::VectorXd weights = BalancedWeights(is_first);
  Standardise(features, weights, model);
  const Eigen::MatrixXd design = Design(features, model);
  const Eigen::Index size = design.cols();
  Eigen::VectorXd beta = Eigen::VectorXd::Zero(size), scores = Eigen::VectorXd::Zero(design.rows());
  Eigen::VectorXd penalty = Eigen::VectorXd::Constant(size, ridge);
  penalty[size - 1] = 0.0;
  double loss = Loss(scores, is_first, weights, penalty, beta);
  for (int i = 0; i < kMostSteps; ++i) {
    const Eigen::VectorXd chance = (1.0 / (1.0 + (-scores.array()).exp())).matrix();
    const Eigen::VectorXd gradient =
        design.transpose() * weights.cwiseProduct(chance - is_first) + penalty.cwiseProduct(beta);
    const Eigen::VectorXd curvature =
        (weights.array() * chance.array() * (1.0 - chance.array())).matrix();
    Eigen::MatrixXd hessian = design.transpose() * curvature.asDiagonal() * design;
    hessian.diagonal() += penalty;
    Eigen::VectorXd step = hessian.ldlt().solve(gradient);
    // A full step may go too far from where the chances are near 0 or 1.
    for (int halvings = 0; halvings < 30; ++halvings, step *= 0.5) {
      const Eigen::VectorXd tried = beta - step;
      const Eigen::VectorXd tried_scores = design * tried;
      const double tried_loss = Loss(tried_scores, is_first, weights, penalty, tried);
      if (!(tried_loss <= loss)) continue;
      beta = tried, scores = tried_scores, loss = tried_loss;
      break;
    }
    if (step.cwiseAbs().maxCoeff() < kConverged) break;
  }
  model.weights = beta.head(size - 1);
  model.intercept = beta[size - 1];
  return model;
}

}  // namespace rift::statistics
