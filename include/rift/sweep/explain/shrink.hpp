#pragma once

#include <functional>
#include <string>
#include <vector>

#include "rift/sweep/falsify/settings.hpp"

namespace rift::sweep {

/// Robustness of a setting: threshold - gap. Below zero it fails; NaN: no gap, so it does not.
using Robustness = std::function<double(const experiment::Theta&)>;

struct ShrinkOptions {
  int max_evaluations = 400;
  double tolerance = 0.02;

  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    field("max_evaluations", self.max_evaluations, 1, 1'000'000, "trials that may be spent");
    field("tolerance", self.tolerance, 1e-6, 0.5,
          "a change is small enough when this share of it less does not fail any more");
  }
};

/// A counterexample with nothing in it that it does not need.
struct ShrunkFailure {
  experiment::Theta theta;
  std::vector<int> changed;               ///< parameters that differ from nominal, in their order
  double robustness = gap::kNotComputed;  ///< of theta, below zero
  int evaluations = 0;
  bool is_fewest = false;   ///< no smaller set of these changes fails (all were tried)
  bool is_minimal = false;  ///< with any one change taken back it holds (each was tried)
};

/// What a failing row of a sweep shrank to, with the trials that the claims rest on.
struct ShrunkRow {
  int id = 0;  ///< of the row in the sweep's table.csv
  experiment::Theta nominal;
  ShrunkFailure shrunk;
  /// The row, the shrunk one, and that without each of its changes.
  std::vector<TrialRow> rows;
};

/// The fewest and smallest changes from `nominal` that still fail: first sets of changes, the small
/// ones first, where they are too many after changes were taken back one by one; then each change
/// towards nominal, through the values of a list or by halving. A word is changed or not. Every
/// claim in the result was tried, never inferred.
/// Throws std::invalid_argument when `failing` does not fail.
ShrunkFailure Shrink(const std::vector<experiment::Parameter>& parameters,
                     const experiment::Theta& nominal, const experiment::Theta& failing,
                     const Robustness& robustness, const ShrinkOptions& options = {});

/// Index of the row that `id` names: its number in table.csv, or "worst". Throws
/// std::invalid_argument when there is no such row, or it does not fail.
int FailingRow(const SweepResult& result, const std::string& id);

/// Shrinks a failing row towards the experiment's own values, with the random numbers that the row
/// had.
ShrunkRow ShrinkRow(const experiment::Experiment& experiment, const SweepResult& result, int index,
                    const ShrinkOptions& options, const RunAllTrials& run);

}  // namespace rift::sweep
