#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "rift/sweep/falsify/result.hpp"

namespace rift::sweep {

struct SobolIndex {
  std::string parameter;
  int index = 0;
  double first = 0.0;  ///< share of the gap's variance by this parameter alone
  double first_low = 0.0, first_high = 0.0;
  double total = 0.0;  ///< the same with all its interactions
  double total_low = 0.0, total_high = 0.0;
};

/// Sobol's indices of the gap over the whole space, from trials wherever they were made: a
/// polynomial chaos expansion is fitted to them and its coefficients give the indices (Sudret
/// 2008). As good as the fit, which `q2` tells; the 95 % intervals are of 100 bootstraps.
struct Sensitivity {
  std::vector<SobolIndex> indices;  ///< by falling total; empty when there are too few trials
  double q2 = gap::kNotComputed;    ///< share of the variance predicted, leaving one trial out
  int degree = 0;                   ///< of the polynomials
  int trials = 0;                   ///< used
  std::string note;                 ///< why there are none, or how far they can be trusted
};

struct SensitivityOptions {
  int most_trials = 2000;  ///< of more, evenly picked ones are used
  int most_terms = 60;
  int most_degree = 8;
  int bootstraps = 100;
  std::uint64_t seed = 1;
};

/// For spaces with a continuous axis. Axes with a list of values take part as factors.
Sensitivity EstimateSensitivity(const SweepResult& result, const SensitivityOptions& options = {});

}  // namespace rift::sweep
