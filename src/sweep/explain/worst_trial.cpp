#include "rift/sweep/explain/worst_trial.hpp"

#include <algorithm>

namespace rift::sweep {

std::optional<std::size_t> WorstTrial(const std::vector<TrialFailure>& trials) {
  std::optional<std::size_t> worst;
  for (std::size_t i = 0; i < trials.size(); ++i) {
    if (!trials[i].gap_m) continue;
    if (!worst || *trials[i].gap_m > *trials[*worst].gap_m) worst = i;
  }
  if (worst && trials[*worst].falsified) return worst;
  const auto failed = std::find_if(trials.begin(), trials.end(),
                                   [](const TrialFailure& trial) { return trial.falsified; });
  if (failed == trials.end()) return worst;
  return static_cast<std::size_t>(failed - trials.begin());
}

std::optional<std::size_t> WorstTrialOf(const SweepResult& result) {
  std::vector<TrialFailure> trials;
  for (const TrialRow& row : result.rows) {
    trials.push_back({.falsified = row.falsified});
    if (row.IsOk()) trials.back().gap_m = row.comparison.gap_m;
  }
  return WorstTrial(trials);
}

}  // namespace rift::sweep
