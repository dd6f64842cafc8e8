#pragma once

#include <span>

namespace rift::statistics {

/// Correlation of the ranks of two lists of one length, equal values having the mean of their ranks
/// (Spearman 1904). Pairs with a NaN are left out; NaN for fewer than three pairs, or when all
/// values of one side are equal.
double RankCorrelation(std::span<const double> a, std::span<const double> b);

}  // namespace rift::statistics
