#pragma once

#include <span>
#include <vector>

#include "rift/sweep/falsify/result.hpp"

namespace rift::sweep {

/// Fills in everything of a result that follows from its parameters and rows: the settings with
/// their verdicts, the effects of the parameters and the summary of all rows. Settings stand in
/// the order of their first rows; their noise floor is left alone.
void Summarise(SweepResult& result);

/// One-way analysis of variance (Fisher 1925) of groups of values.
struct AnalysisOfVariance {
  double f = gap::kNotComputed;  ///< NaN for fewer than two groups or no spread within them
  double df_between = 0.0;
  double df_within = 0.0;
  double p = gap::kNotComputed;
  double eta_squared = gap::kNotComputed;
  double omega_squared = gap::kNotComputed;  ///< Hays 1963; not below zero
};

/// Groups without values are ignored.
AnalysisOfVariance AnalyseVariance(const std::vector<std::vector<double>>& groups);

/// A parameter with a p below this has a detected effect.
inline constexpr double kSignificance = 0.05;

}  // namespace rift::sweep
