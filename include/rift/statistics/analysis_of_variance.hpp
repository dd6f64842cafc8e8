#pragma once

#include <limits>
#include <vector>

namespace rift::statistics {

/// One-way analysis of variance (Fisher 1925) of groups of values.
struct AnalysisOfVariance {
  static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  double f = kNone;  ///< NaN for fewer than two groups or no spread within them
  double df_between = 0.0;
  double df_within = 0.0;
  double p = kNone;
  double eta_squared = kNone;
  double omega_squared = kNone;  ///< Hays 1963; not below zero
};

/// Groups without values are ignored.
AnalysisOfVariance AnalyseVariance(const std::vector<std::vector<double>>& groups);

}  // namespace rift::statistics
