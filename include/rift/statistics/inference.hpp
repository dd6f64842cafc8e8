#pragma once

#include <limits>
#include <span>
#include <vector>

namespace rift::statistics {

/// Distribution functions and their inverses, by Boost.Math. A share lies in (0, 1), degrees of
/// freedom are above 0; Boost throws std::domain_error otherwise.

double NormalCdf(double z);
/// sqrt(2) erf_inv(2 share - 1); shares below 1e-8 lose digits in 2 share - 1.
double NormalQuantile(double share);
/// Mean of a normal variable of which nothing lies outside [low, high]; `mean` and `sd` are those
/// before, `mean` within [low, high], `sd` above 0.
double MeanOfNormalWithin(double mean, double sd, double low, double high);
double StudentQuantile(double degrees_of_freedom, double share);

/// Probability of `successes` in `trials`, each with the probability `share`, which may be 0 or 1.
double BinomialPdf(int trials, double share, int successes);

/// Share below x, in [0, 1], of the beta distribution with a, b > 0.
double BetaCdf(double a, double b, double x);

/// Share of the F distribution above f: the p value of an F test.
double FUpperTail(double df1, double df2, double f);
/// The value that a share `upper_tail` of the F distribution exceeds.
double FCriticalValue(double df1, double df2, double upper_tail);
/// Share below f of the F distribution with the noncentrality lambda >= 0.
double NoncentralFCdf(double df1, double df2, double lambda, double f);

struct Interval {
  double low = 0.0;
  double high = 0.0;
};

/// For the share of successes that `successes` of `trials` were drawn from: exact for a binomial
/// count, so never too narrow (Clopper and Pearson 1934). [0, 1] without a trial. Throws
/// std::invalid_argument unless 0 <= successes <= trials and 0 < confidence < 1.
Interval ClopperPearson(int successes, int trials, double confidence);

/// For the mean that normal values with an unknown spread were drawn from, by Student's t. NaN for
/// fewer than two values.
Interval MeanInterval(std::span<const double> values, double confidence);

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
