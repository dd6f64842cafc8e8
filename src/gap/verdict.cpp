#include "rift/gap/verdict.hpp"

#include <cmath>

#include "rift/gap/comparison.hpp"
#include "rift/statistics/intervals.hpp"
#include "rift/statistics/mean.hpp"

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

}  // namespace rift::gap
