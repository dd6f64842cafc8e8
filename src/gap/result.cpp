#include "rift/gap/result.hpp"

#include <cmath>

#include "rift/gap/comparison.hpp"
#include "rift/statistics/descriptive.hpp"
#include "rift/statistics/inference.hpp"

namespace rift::gap {

RepeatVerdict JudgeRepeats(std::span<const double> gaps_m, double threshold_m, double confidence) {
  RepeatVerdict verdict;
  verdict.confidence = confidence;
  for (const double gap_m : gaps_m) {
    if (std::isnan(gap_m)) continue;
    ++verdict.repeats;
    verdict.above += gap_m > threshold_m;
  }
  if (verdict.repeats == 0) return verdict;
  if (verdict.above == verdict.repeats) verdict.verdict = Verdict::kFalsified;
  if (verdict.above == 0) verdict.verdict = Verdict::kNotFalsified;
  const statistics::Interval share =
      statistics::ClopperPearson(verdict.above, verdict.repeats, confidence);
  verdict.share_low = share.low;
  verdict.share_high = share.high;
  return verdict;
}

double NoiseFloor_m(std::span<const trajectory::Trajectory> reals, const GapOptions& options) {
  std::vector<double> gaps_m;
  for (size_t i = 0; i < reals.size(); ++i) {
    for (size_t j = i + 1; j < reals.size(); ++j) {
      gaps_m.push_back(Gap(reals[i], reals[j], options));
    }
  }
  return statistics::Mean(gaps_m);
}

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
