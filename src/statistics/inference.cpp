#include "rift/statistics/inference.hpp"

#include <boost/math/distributions/binomial.hpp>
#include <boost/math/distributions/fisher_f.hpp>
#include <boost/math/distributions/non_central_f.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <boost/math/special_functions/beta.hpp>
#include <boost/math/special_functions/erf.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <stdexcept>

#include "rift/statistics/descriptive.hpp"

namespace rift::statistics {

namespace math = boost::math;

double NormalCdf(double z) { return math::cdf(math::normal(), z); }

double NormalQuantile(double share) {
  return std::numbers::sqrt2 * math::erf_inv(2.0 * share - 1.0);
}

double MeanOfNormalWithin(double mean, double sd, double low, double high) {
  const double from = (low - mean) / sd, to = (high - mean) / sd;
  const math::normal normal;
  return mean + sd * (math::pdf(normal, from) - math::pdf(normal, to)) /
                    (math::cdf(normal, to) - math::cdf(normal, from));
}

double StudentQuantile(double degrees_of_freedom, double share) {
  return math::quantile(math::students_t(degrees_of_freedom), share);
}

double BinomialPdf(int trials, double share, int successes) {
  return math::pdf(math::binomial(trials, share), successes);
}

double BetaCdf(double a, double b, double x) { return math::ibeta(a, b, x); }

double FUpperTail(double df1, double df2, double f) {
  return math::cdf(math::complement(math::fisher_f(df1, df2), f));
}

double FCriticalValue(double df1, double df2, double upper_tail) {
  return math::quantile(math::complement(math::fisher_f(df1, df2), upper_tail));
}

double NoncentralFCdf(double df1, double df2, double lambda, double f) {
  constexpr double kSeriesIsSlow = 200.0;
  if (lambda <= 0.0) return math::cdf(math::fisher_f(df1, df2), f);
  if (lambda > kSeriesIsSlow) {  // Patnaik 1949: a central F with the same first two moments
    const double scale = (df1 + lambda) / df1;
    const double df = std::pow(df1 + lambda, 2) / (df1 + 2.0 * lambda);
    return math::cdf(math::fisher_f(df, df2), f / scale);
  }
  return math::cdf(math::non_central_f(df1, df2, lambda), f);
}

Interval ClopperPearson(int successes, int trials, double confidence) {
  if (successes < 0 || successes > trials) {
    throw std::invalid_argument("Clopper-Pearson: successes must lie between 0 and the trials");
  }
  if (!(confidence > 0.0 && confidence < 1.0)) {
    throw std::invalid_argument("Clopper-Pearson: the confidence must lie between 0 and 1");
  }
  const double k = successes, n = trials;
  const double tail = (1.0 - confidence) / 2.0;
  return {successes == 0 ? 0.0 : boost::math::ibeta_inv(k, n - k + 1.0, tail),
          successes == trials ? 1.0 : boost::math::ibeta_inv(k + 1.0, n - k, 1.0 - tail)};
}

Interval MeanInterval(std::span<const double> values, double confidence) {
  if (values.size() < 2) {
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    return {kNone, kNone};
  }
  const double mean = Mean(values);
  const double t = StudentQuantile(static_cast<double>(values.size() - 1), 0.5 + 0.5 * confidence);
  const double reach = t * StandardError(values);
  return {mean - reach, mean + reach};
}

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
