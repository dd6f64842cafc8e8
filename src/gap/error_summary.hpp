#pragma once

#include <vector>

#include "rift/gap/comparison.hpp"

namespace rift::gap {

/// Sets mean, RMS, median and 95 % of the errors at the samples.
void SummariseErrors(std::vector<double> errors_m, Comparison& result);

/// Sets mean and maximum of the sizes of those that are not NaN; nothing without any.
void SummariseYawErrors(std::vector<double> errors_rad, Comparison& result);

}  // namespace rift::gap
