#pragma once

namespace rift::statistics {

/// Distribution functions and their inverses, by Boost.Math. A share lies in (0, 1), degrees of
/// freedom are above 0; Boost throws std::domain_error otherwise.

double NormalCdf(double z);
/// sqrt(2) erf_inv(2 share - 1); shares below 1e-8 lose digits in 2 share - 1.
double NormalQuantile(double share);
double StudentQuantile(double degrees_of_freedom, double share);

/// Probability of `successes` in `trials`, each with the probability `share`, which may be 0 or 1.
double BinomialPdf(int trials, double share, int successes);

/// Share of the F distribution above f: the p value of an F test.
double FUpperTail(double df1, double df2, double f);
/// The value that a share `upper_tail` of the F distribution exceeds.
double FCriticalValue(double df1, double df2, double upper_tail);
/// Share below f of the F distribution with the noncentrality lambda >= 0.
double NoncentralFCdf(double df1, double df2, double lambda, double f);

}  // namespace rift::statistics
