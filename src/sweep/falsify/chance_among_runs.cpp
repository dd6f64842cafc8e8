#include "rift/sweep/falsify/chance_among_runs.hpp"

#include <algorithm>

namespace rift::sweep {

void ChanceAmongRuns::Note(const std::vector<const TrialRow*>& trials) {
  std::vector<std::pair<Run, std::uint64_t>> driven;
  for (const TrialRow* row : trials) {
    if (!row->seed || !row->Tells() || row->evidence.fingerprint == 0) continue;
    driven.push_back({{row->evidence.fingerprint, row->status}, *row->seed});
  }
  const bool parts = std::any_of(driven.begin(), driven.end(), [&](const auto& trial) {
    return trial.first != driven.front().first;
  });
  for (const auto& [run, seed] : driven) {
    Use& use = uses_.try_emplace(run, Use{.seed = seed}).first->second;
    use.has_other_seed = use.has_other_seed || use.seed != seed;
    use.is_of_parted = use.is_of_parted || parts;
    is_seen_ = is_seen_ || (use.has_other_seed && use.is_of_parted);
  }
}

}  // namespace rift::sweep
