#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "rift/sweep/falsify/result.hpp"

namespace rift::sweep {

/// Order of a function on each axis; 0: the axis takes no part.
using Orders = std::vector<int>;

/// Trials as a regression sees them.
struct Observations {
  std::vector<const TrialRow*> rows;
  std::vector<int> parameters;  ///< those that have more than one value in the rows
  Eigen::VectorXd losses_m;     ///< one a row
  int most_of_setting = 0;      ///< first trials of a setting that are looked at; 0: all of them
  bool are_same_runs = false;   ///< several settings tell, and all of them by the same runs
};

/// Of the distinct trials that tell the first of each setting (FirstOfEachSetting), a sample when
/// there are more than `most`.
Observations Observe(const SweepResult& result, int most);

/// A linear model of the loss. Columns are products of orthonormal functions of the axes, one axis
/// for each observed parameter; the first is constant.
struct Expansion {
  std::vector<Orders> terms;  ///< one a column
  Eigen::MatrixXd design;     ///< a row for each trial
  int degree = 0;             ///< 0: there is none
  double predicted = -1.0;    ///< share of the variance that it predicts leaving one trial out
};

struct ExpansionLimits {
  int most_terms = 60;
  int most_degree = 8;
};

/// The degree that predicts best; degree 1 whenever two residual degrees of freedom are left to it.
Expansion BestExpansion(const SweepResult& result, const Observations& data,
                        const ExpansionLimits& limits);

/// Least squares of some columns of a model.
class Regression {
 public:
  Regression(const Expansion& expansion, const Eigen::VectorXd& losses_m);

  struct Fit {
    double sse = 0.0;   ///< sum of squared errors, m^2
    double rank = 0.0;  ///< columns that are not combinations of others
  };
  /// The columns whose orders are wanted; the constant always is.
  Fit With(const std::function<bool(const Orders&)>& is_wanted) const;
  double Total() const { return total_; }  ///< sum of squares around the mean, m^2

 private:
  const std::vector<Orders>& terms_;
  Eigen::MatrixXd xx_;
  Eigen::VectorXd xy_;
  double total_ = 0.0;
};

}  // namespace rift::sweep
