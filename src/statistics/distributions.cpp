#include "rift/statistics/distributions.hpp"

#include <boost/math/distributions/binomial.hpp>
#include <boost/math/distributions/fisher_f.hpp>
#include <boost/math/distributions/non_central_f.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <boost/math/special_functions/erf.hpp>
#include <cmath>
#include <numbers>

namespace rift::statistics {

namespace math = boost::math;

double NormalCdf(double z) { return math::cdf(math::normal(), z); }

double NormalQuantile(double share) {
  return std::numbers::sqrt2 * math::erf_inv(2.0 * share - 1.0);
}

double StudentQuantile(double degrees_of_freedom, double share) {
  return math::quantile(math::students_t(degrees_of_freedom), share);
}

double BinomialPdf(int trials, double share, int successes) {
  return math::pdf(math::binomial(trials, share), successes);
}

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

}  // namespace rift::statistics
