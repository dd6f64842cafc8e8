#include "rift/sweep/explain/failure_probability.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace rift::sweep {

FailureProbability EstimateFailureProbability(const SweepResult& result) {
  FailureProbability estimate;
  std::vector<double> is_failure;
  for (const SettingResult& setting : result.settings) {
    const bool is_draw = result.rows[setting.rows.front()].is_random_draw;
    if (!is_draw) continue;
    if (setting.verdict.repeats == 0) {
      ++estimate.without_gap;
    } else {
      is_failure.push_back(setting.verdict.above > 0 ? 1.0 : 0.0);
    }
  }
  const gap::RepeatVerdict verdict = gap::JudgeRepeats(is_failure, 0.5, estimate.confidence);
  estimate.draws = verdict.repeats;
  estimate.failures = verdict.above;
  if (estimate.draws == 0) {
    estimate.sentence =
        "How often it fails over the whole space is not known: the settings were chosen, not drawn "
        "at random";
    return estimate;
  }
  estimate.low = verdict.share_low;
  estimate.high = verdict.share_high;
  estimate.share = static_cast<double>(estimate.failures) / estimate.draws;
  estimate.sentence = fmt::format(
      "Over the space {:.3g} % of the settings fail, between {:.3g} and {:.3g} % with 95 % "
      "confidence (Clopper-Pearson, {} of {} settings drawn at random{})",
      100.0 * estimate.share, 100.0 * estimate.low, 100.0 * estimate.high, estimate.failures,
      estimate.draws,
      estimate.without_gap > 0 ? fmt::format("; {} more gave no gap", estimate.without_gap) : "");
  return estimate;
}

}  // namespace rift::sweep
