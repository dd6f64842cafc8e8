#pragma once

#include <utility>

#include "rift/sweep/falsify/result.hpp"

namespace rift::sweep {

/// A trial of which nothing but its setting and its gap is told.
inline TrialRow Row(experiment::Theta theta, double gap_m) {
  TrialRow row{.theta = std::move(theta)};
  row.comparison.gap_m = gap_m;
  return row;
}

}  // namespace rift::sweep
