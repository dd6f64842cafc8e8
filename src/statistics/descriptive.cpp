#include "rift/statistics/descriptive.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <utility>
#include <vector>

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

namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// Squared standard deviation. In two passes: the sum of squares less the square of the sum loses
/// all digits when the mean is much larger than the spread.
double Variance(std::span<const double> values) {
  if (values.size() < 2) return kNone;
  const double mean = Mean(values);
  double squares = 0.0;
  for (const double value : values) squares += (value - mean) * (value - mean);
  return squares / static_cast<double>(values.size() - 1);
}

}  // namespace

double Mean(std::span<const double> values) {
  if (values.empty()) return kNone;
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double MeanOfKnown(std::span<const double> values) {
  std::vector<double> known;
  std::copy_if(values.begin(), values.end(), std::back_inserter(known),
               [](double value) { return !std::isnan(value); });
  return Mean(known);
}

double StandardDeviation(std::span<const double> values) { return std::sqrt(Variance(values)); }

double RootMeanSquare(std::span<const double> values) {
  return std::sqrt(std::inner_product(values.begin(), values.end(), values.begin(), 0.0) /
                   static_cast<double>(values.size()));
}

double StandardError(std::span<const double> values) {
  return std::sqrt(Variance(values) / static_cast<double>(values.size()));
}

}  // namespace rift::statistics
