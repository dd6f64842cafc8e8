#pragma once

#include <Eigen/Core>

namespace rift::statistics {

/// A linear classifier: positive scores are of the first class.
struct LogisticModel {
  Eigen::VectorXd mean;     ///< of each feature, with both classes of the same weight
  Eigen::VectorXd inverse;  ///< of its standard deviation; 0 where it has none
  Eigen::VectorXd weights;  ///< of standardised features
  double intercept = 0.0;

  /// Scores of the rows of a matrix; NaN in it counts as the mean.
  Eigen::VectorXd Scores(const Eigen::MatrixXd& features) const;
};

/// Logistic regression by Newton's method: `features` has a row for each observation, `is_first` is
/// 1 or 0, and both must occur. Each class weighs as much as the smaller one has observations, and
/// ridge / 2 times the squared weights is added to the loss; the intercept is free.
LogisticModel FitLogistic(const Eigen::MatrixXd& features, const Eigen::VectorXd& is_first,
                          double ridge);

}  // namespace rift::statistics
