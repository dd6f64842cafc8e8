#pragma once

#include <span>

namespace rift::statistics {

struct Interval {
  double low = 0.0;
  double high = 0.0;
};

/// For the share of successes that `successes` of `trials` were drawn from: exact for a binomial
/// count, so never too narrow (Clopper and Pearson 1934). [0, 1] without a trial. Throws
/// std::invalid_argument unless 0 <= successes <= trials and 0 < confidence < 1.
Interval ClopperPearson(int successes, int trials, double confidence);

/// For the mean that normal values with an unknown spread were drawn from, by Student's t. NaN for
/// fewer than two values.
Interval MeanInterval(std::span<const double> values, double confidence);

}  // namespace rift::statistics
