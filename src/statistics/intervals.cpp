#include "rift/statistics/intervals.hpp"

#include <boost/math/special_functions/beta.hpp>
#include <limits>
#include <stdexcept>

#include "rift/statistics/distributions.hpp"
#include "rift/statistics/mean.hpp"

namespace rift::statistics {

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

}  // namespace rift::statistics
