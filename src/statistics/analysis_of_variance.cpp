#include "rift/statistics/analysis_of_variance.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "rift/statistics/distributions.hpp"
#include "rift/statistics/mean.hpp"

namespace rift::statistics {
namespace {

struct SumsOfSquares {
  double between = 0.0;
  double within = 0.0;
  double values = 0.0;  ///< how many
  double groups = 0.0;
};

SumsOfSquares SplitVariance(const std::vector<std::vector<double>>& groups) {
  SumsOfSquares sums;
  double total = 0.0;
  for (const auto& group : groups) {
    total += std::accumulate(group.begin(), group.end(), 0.0);
    sums.values += static_cast<double>(group.size());
    sums.groups += group.empty() ? 0.0 : 1.0;
  }
  for (const auto& group : groups) {
    if (group.empty()) continue;
    const double mean = Mean(group);
    sums.between += static_cast<double>(group.size()) * std::pow(mean - total / sums.values, 2);
    for (const double value : group) sums.within += std::pow(value - mean, 2);
  }
  return sums;
}

}  // namespace

AnalysisOfVariance AnalyseVariance(const std::vector<std::vector<double>>& groups) {
  const SumsOfSquares sums = SplitVariance(groups);
  AnalysisOfVariance result;
  result.df_between = sums.groups - 1.0;
  result.df_within = sums.values - sums.groups;
  const double total = sums.between + sums.within;
  if (result.df_between < 1.0 || result.df_within < 1.0 || !(sums.within > 0.0)) return result;

  const double mean_within = sums.within / result.df_within;
  result.f = sums.between / result.df_between / mean_within;
  result.p = FUpperTail(result.df_between, result.df_within, result.f);
  result.eta_squared = sums.between / total;
  result.omega_squared =
      std::max(0.0, (sums.between - result.df_between * mean_within) / (total + mean_within));
  return result;
}

}  // namespace rift::statistics
