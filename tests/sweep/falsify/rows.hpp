#pragma once

#include "rift/sweep/falsify/result.hpp"

namespace rift::sweep {

/// A trial with that gap, which fails above 0.06 m.
inline TrialRow Ok(double gap_m, std::uint64_t fingerprint = 0) {
  TrialRow row;
  row.comparison.gap_m = gap_m;
  row.falsified = gap_m > 0.06;
  row.evidence.fingerprint = fingerprint;
  return row;
}

/// A trial that ran out of its time, so far from the last waypoint.
inline TrialRow Failed(double left_m, std::uint64_t fingerprint = 0) {
  TrialRow row;
  row.status = TrialStatus::kTimedOut;
  row.falsified = true;
  row.left_m = left_m;
  row.evidence.fingerprint = fingerprint;
  return row;
}

}  // namespace rift::sweep
