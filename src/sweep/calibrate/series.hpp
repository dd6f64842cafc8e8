#pragma once

#include <cstddef>
#include <functional>
#include <vector>

namespace rift::sweep {

/// Numbers that a sequence of values is told by; NaN when it is too short or does not vary.

double ShareOf(const std::vector<double>& values, const std::function<bool(double)>& is_meant);

/// The standard deviation of normal values about zero with this median size: two rows stamped
/// nearly at once decide nothing.
double RobustScatter(std::vector<double> values);

/// With itself `lag` values later; at least eight pairs.
double Autocorrelation(const std::vector<double>& values, size_t lag);

/// Sarle's coefficient: 1/3 of normal values, 5/9 of evenly spread ones, 1 of two points.
double Bimodality(const std::vector<double>& values);

}  // namespace rift::sweep
