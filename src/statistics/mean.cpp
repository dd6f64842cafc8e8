#include "rift/statistics/mean.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>
#include <vector>

namespace rift::statistics {
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

double StandardError(std::span<const double> values) {
  return std::sqrt(Variance(values) / static_cast<double>(values.size()));
}

}  // namespace rift::statistics
