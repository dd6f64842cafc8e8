#pragma once

#include <string>
#include <vector>

#include "rift/sweep/falsify/result.hpp"

namespace rift::sweep {

/// What a parameter has to do with the loss: the one measure that everything is ordered by.
struct ParameterEffect {
  int parameter = 0;  ///< index into SweepResult::parameters
  std::string name;
  /// Share of the loss's variance over the trials that goes with the parameter, by itself or
  /// together with others, less what chance alone would explain (omega squared of the model with
  /// it against the model without it, Hays 1963; over an evenly filled space Sobol's total index,
  /// Sudret 2008, less up to columns / trials of it). What two parameters do together counts in
  /// both, what the trials cannot tell apart in neither. 0 to 1; NaN where it cannot be estimated.
  double share = gap::kNotComputed;
  /// 95 % interval, noncentral F (Steiger 2004): a noncentrality lambda is a share of lambda over
  /// lambda and all that the parameter does not explain, of which the trials tell with one degree
  /// of freedom less than there are of them. Its upper end is that of an F of 1 or more.
  double share_low = gap::kNotComputed;
  double share_high = gap::kNotComputed;
  double alone = gap::kNotComputed;   ///< of it by the parameter itself
  double df = 0.0;                    ///< columns of the model that involve it
  double p = gap::kNotComputed;       ///< of the F test of those columns
  std::vector<std::string> together;  ///< parameters that it is seen to act together with
  std::string sentence;               ///< "surface: 63 % of the loss's variance goes with it ..."

  /// The interval is above zero: the only threshold there is for words and charts.
  bool IsSeen() const { return share_low > 0.0; }
};

/// Effects of all parameters that were varied, the largest share first. They come of one linear
/// model of the loss: products of orthonormal functions of the parameters (Legendre polynomials of
/// a range, contrasts of a list), of the degree that predicts best what was left out.
struct Effects {
  std::vector<ParameterEffect> parameters;
  int trials = 0;  ///< distinct ones that tell, at most EffectOptions::most_trials
  int degree = 0;  ///< of the model; 0: there is none
  double residual_df = 0.0;
  double residual_sd_m = gap::kNotComputed;  ///< what the model does not explain
  double explained = gap::kNotComputed;      ///< share of the variance that it explains
  double predicted = gap::kNotComputed;      ///< of trials left out, one at a time; may be below 0
  std::string note;                          ///< of what model, or why there is none

  /// Null when the parameter was not varied, or nothing can be estimated.
  const ParameterEffect* Of(int parameter) const;
};

struct EffectOptions {
  int most_trials = 2000;  ///< of more, evenly picked ones are used
  int most_terms = 60;     ///< of a model with interactions or curves
  int most_degree = 8;
};

Effects MeasureEffects(const SweepResult& result, const EffectOptions& options = {});

/// The least difference between the means of two values, all others in the middle between them,
/// that an F test at 5 % finds with probability `power`. `counts`: trials of each value. NaN where
/// no test is possible.
double SmallestDetectable(const std::vector<int>& counts, double sd, double residual_df,
                          double power);

}  // namespace rift::sweep
