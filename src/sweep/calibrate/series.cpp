#include "series.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "rift/gap/comparison.hpp"
#include "rift/statistics/descriptive.hpp"

namespace rift::sweep {

double ShareOf(const std::vector<double>& values, const std::function<bool(double)>& is_meant) {
  if (values.empty()) return gap::kNotComputed;
  const auto count = std::count_if(values.begin(), values.end(), is_meant);
  return static_cast<double>(count) / static_cast<double>(values.size());
}

double RobustScatter(std::vector<double> values) {
  for (double& value : values) value = std::abs(value);
  return statistics::kSigmaOfMedianDeviation * statistics::Median(std::move(values));
}

double Autocorrelation(const std::vector<double>& values, size_t lag) {
  if (values.size() < lag + 8) return gap::kNotComputed;
  const double mean = statistics::Mean(values);
  double product = 0.0, squares = 0.0;
  for (size_t i = 0; i < values.size(); ++i) {
    squares += (values[i] - mean) * (values[i] - mean);
    if (i >= lag) product += (values[i] - mean) * (values[i - lag] - mean);
  }
  return squares > 0.0 ? product / squares : gap::kNotComputed;
}

double Bimodality(const std::vector<double>& values) {
  const double mean = statistics::Mean(values);
  double m2 = 0.0, m3 = 0.0, m4 = 0.0;
  for (const double value : values) {
    const double d = value - mean;
    m2 += d * d, m3 += d * d * d, m4 += d * d * d * d;
  }
  const double n = static_cast<double>(values.size());
  m2 /= n, m3 /= n, m4 /= n;
  return m4 > 0.0 ? (m3 * m3 / (m2 * m2 * m2) + 1.0) / (m4 / (m2 * m2)) : gap::kNotComputed;
}

}  // namespace rift::sweep
