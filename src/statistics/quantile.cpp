#include "rift/statistics/quantile.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <stdexcept>
#include <utility>

namespace rift::statistics {

double Quantile(std::vector<double> values, double share) {
  if (!(share >= 0.0 && share <= 1.0)) {
    throw std::invalid_argument("quantile: the share must lie between 0 and 1");
  }
  const bool has_nan =
      std::any_of(values.begin(), values.end(), [](double value) { return std::isnan(value); });
  if (values.empty() || has_nan) return std::numeric_limits<double>::quiet_NaN();
  const double position = share * static_cast<double>(values.size() - 1);
  const auto below = values.begin() + static_cast<std::ptrdiff_t>(position);
  std::nth_element(values.begin(), below, values.end());
  const double fraction = position - std::floor(position), low = *below;
  if (fraction == 0.0) return low;
  const double high = *std::min_element(below + 1, values.end());
  return low == high ? low : low + fraction * (high - low);  // infinities less each other are NaN
}

double Median(std::vector<double> values) { return Quantile(std::move(values), 0.5); }

Interval CentralInterval(const std::vector<double>& values, double confidence) {
  return {Quantile(values, 0.5 * (1.0 - confidence)), Quantile(values, 0.5 * (1.0 + confidence))};
}

}  // namespace rift::statistics
