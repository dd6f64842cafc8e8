#include "error_summary.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "rift/statistics/mean.hpp"
#include "rift/statistics/quantile.hpp"

namespace rift::gap {

void SummariseErrors(std::vector<double> errors_m, Comparison& result) {
  result.mean_error_m = statistics::Mean(errors_m);
  double squares = 0.0;
  for (const double error_m : errors_m) squares += error_m * error_m;
  result.rms_error_m = std::sqrt(squares / static_cast<double>(errors_m.size()));
  result.median_error_m = statistics::Median(errors_m);
  result.p95_error_m = statistics::Quantile(std::move(errors_m), 0.95);
}

void SummariseYawErrors(std::vector<double> errors_rad, Comparison& result) {
  std::erase_if(errors_rad, [](double error_rad) { return std::isnan(error_rad); });
  if (errors_rad.empty()) return;
  for (double& error_rad : errors_rad) error_rad = std::abs(error_rad);
  result.mean_yaw_error_rad = statistics::Mean(errors_rad);
  result.max_yaw_error_rad = *std::max_element(errors_rad.begin(), errors_rad.end());
}

}  // namespace rift::gap
