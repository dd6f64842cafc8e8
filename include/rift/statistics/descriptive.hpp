#pragma once

#include <span>
#include <vector>

#include "rift/statistics/inference.hpp"

namespace rift::statistics {

/// The value that a share of the values does not exceed, interpolated linearly between the order
/// statistics around position share * (n - 1), counted from 0: definition 7 of Hyndman and Fan 1996
/// ("Sample quantiles in statistical packages"), which numpy and R use unless told otherwise. The
/// 0.95 quantile of 1, 2, ..., 10 is 9.55. This is the only definition in rift.
///
/// Values come in any order. NaN of none, and NaN when one of them is NaN: whoever wants to leave
/// those out does so first. Throws std::invalid_argument unless 0 <= share <= 1.
double Quantile(std::vector<double> values, double share);

/// Quantile at 0.5: the middle value, or half way between the middle two.
double Median(std::vector<double> values);

/// Between the quantiles that leave out (1 - confidence) / 2 on each side: the percentile interval
/// of bootstrap values (Efron 1979).
Interval CentralInterval(const std::vector<double>& values, double confidence);

/// Times the median absolute deviation: the standard deviation of normal values.
inline constexpr double kSigmaOfMedianDeviation = 1.4826;

/// Of all values, so NaN when one is NaN; NaN of none.
double Mean(std::span<const double> values);

/// Of the values that are not NaN; NaN of none.
double MeanOfKnown(std::span<const double> values);

/// sqrt(mean of squares); NaN of none, or when one is NaN.
double RootMeanSquare(std::span<const double> values);

/// Of the population that the values are a sample of (n - 1 below the fraction). NaN for fewer than
/// two values, or when one is NaN.
double StandardDeviation(std::span<const double> values);

/// Of the mean of the values: the standard deviation over sqrt(n).
double StandardError(std::span<const double> values);

}  // namespace rift::statistics
