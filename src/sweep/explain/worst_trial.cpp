#include "rift/sweep/explain/worst_trial.hpp"

namespace rift::sweep {

namespace {

bool IsWorse(const TrialFailure& a, const TrialFailure& b) {
  if (a.falsified != b.falsified) return a.falsified;
  return a.falsified ? a.loss_m > b.loss_m : *a.gap_m > *b.gap_m;
}

}  // namespace

TrialFailure FailureOf(const TrialRow& row, double threshold_m) {
  TrialFailure trial{.falsified = row.falsified};
  if (row.IsOk()) trial.gap_m = row.comparison.gap_m;
  if (row.falsified) trial.loss_m = Loss_m(row, threshold_m);
  return trial;
}

std::optional<std::size_t> WorstTrial(const std::vector<TrialFailure>& trials) {
  std::optional<std::size_t> worst;
  for (std::size_t i = 0; i < trials.size(); ++i) {
    if (!trials[i].falsified && !trials[i].gap_m) continue;
    if (!worst || IsWorse(trials[i], trials[*worst])) worst = i;
  }
  return worst;
}

std::optional<std::size_t> WorstTrialOf(const SweepResult& result) {
  std::vector<TrialFailure> trials;
  for (const TrialRow& row : result.rows) {
    trials.push_back(FailureOf(row, result.gap.threshold_m));
  }
  return WorstTrial(trials);
}

}  // namespace rift::sweep
