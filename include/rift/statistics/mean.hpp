#pragma once

#include <span>

namespace rift::statistics {

/// Of all values, so NaN when one is NaN; NaN of none.
double Mean(std::span<const double> values);

/// Of the values that are not NaN; NaN of none.
double MeanOfKnown(std::span<const double> values);

/// Of the population that the values are a sample of (n - 1 below the fraction). NaN for fewer than
/// two values, or when one is NaN.
double StandardDeviation(std::span<const double> values);

/// Of the mean of the values: the standard deviation over sqrt(n).
double StandardError(std::span<const double> values);

}  // namespace rift::statistics
