#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "rift/sweep/falsify/result.hpp"

namespace rift::sweep {

/// What decides which trial of a sweep is the worst.
struct TrialFailure {
  std::optional<double> gap_m;  ///< nothing where it has none
  bool falsified = false;
  double loss_m = gap::kNotComputed;  ///< Loss_m, of one that fails
};

TrialFailure FailureOf(const TrialRow& row, double threshold_m);

/// Index of the failing trial with the largest loss; where none fails, of that with the largest
/// gap; of equal ones the first. Nothing when no trial has a gap or fails. The one meaning of
/// "worst" on the command line.
std::optional<std::size_t> WorstTrial(const std::vector<TrialFailure>& trials);
/// The same of the rows of a sweep.
std::optional<std::size_t> WorstTrialOf(const SweepResult& result);

}  // namespace rift::sweep
