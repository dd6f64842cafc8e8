#include "rift/gap/verdict.hpp"

#include <algorithm>
#include <boost/math/special_functions/beta.hpp>
#include <cmath>

#include "rift/gap/comparison.hpp"

namespace rift::gap {
namespace {

/// Clopper and Pearson 1934, exact for a binomial count.
void SetShareInterval(RepeatVerdict& verdict) {
  const double k = verdict.above, n = verdict.repeats;
  const double tail = (1.0 - verdict.confidence) / 2.0;
  verdict.share_low = k == 0.0 ? 0.0 : boost::math::ibeta_inv(k, n - k + 1.0, tail);
  verdict.share_high = k == n ? 1.0 : boost::math::ibeta_inv(k + 1.0, n - k, 1.0 - tail);
}

}  // namespace

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
  SetShareInterval(verdict);
  return verdict;
}

double NoiseFloor_m(std::span<const trajectory::Trajectory> reals, const GapOptions& options) {
  double sum_m = 0.0;
  int pairs = 0;
  for (size_t i = 0; i < reals.size(); ++i) {
    for (size_t j = i + 1; j < reals.size(); ++j, ++pairs) {
      sum_m += Gap(reals[i], reals[j], options);
    }
  }
  return pairs > 0 ? sum_m / pairs : kNotComputed;
}

}  // namespace rift::gap
