#pragma once

#include <string>
#include <vector>

#include "rift/sweep/falsify/result.hpp"

namespace rift::sweep {

/// A parameter, or two of them together, in the linear model of the loss.
struct FactorialTerm {
  std::vector<int> parameters;  ///< indices; one for a main effect, two for an interaction
  std::string name;             ///< "surface", "surface x v_min"
  double df = 0.0;
  double f = gap::kNotComputed;
  double p = gap::kNotComputed;
  /// Share of the variance, of what the other terms leave, that it explains: partial omega squared
  /// (Hays 1963), and its 95 % interval from the noncentral F distribution (Steiger 2004).
  double share = gap::kNotComputed;
  double share_low = gap::kNotComputed;
  double share_high = gap::kNotComputed;

  bool IsInteraction() const { return parameters.size() > 1; }
};

/// Main effects and two-way interactions of the parameters with a list of values. Unlike one
/// analysis of variance for each parameter, a term is judged beside all the others (type II sums of
/// squares), so an uneven table blames no parameter for what another one does.
struct FactorialAnalysis {
  std::vector<FactorialTerm> terms;  ///< main effects in the order of the parameters first
  int n = 0;                         ///< distinct trials that tell
  double residual_df = 0.0;
  double residual_sd_m = gap::kNotComputed;  ///< what no term explains
  double explained = gap::kNotComputed;      ///< share of the variance that all terms explain
  bool has_interactions = false;             ///< false where there are too few trials for them

  /// The main effect of a parameter; null when it had one value, or is no list.
  const FactorialTerm* Main(int parameter) const;
};

FactorialAnalysis AnalyseFactors(const SweepResult& result);

/// The least difference between the means of two values, all others in the middle between them,
/// that an F test at 5 % finds with probability `power`. `counts`: trials of each value. NaN where
/// no test is possible.
double SmallestDetectable(const std::vector<int>& counts, double sd, double residual_df,
                          double power);

}  // namespace rift::sweep
