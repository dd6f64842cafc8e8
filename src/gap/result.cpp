#include "rift/gap/result.hpp"

namespace rift::gap {

void Judge(GapResult& result) {
  std::vector<double> gaps_m;
  double sum_m = 0.0;
  for (const GapResult::Trial& trial : result.trials) {
    gaps_m.push_back(trial.comparison.gap_m);
    sum_m += trial.comparison.gap_m;
  }
  result.mean_gap_m = sum_m / static_cast<double>(gaps_m.size());
  result.noise_floor_m = NoiseFloor_m(result.reals, result.options);
  result.verdict = JudgeRepeats(gaps_m, result.options.threshold_m);
}

}  // namespace rift::gap
