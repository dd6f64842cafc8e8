#include "rift/sweep/falsify/verdict.hpp"

#include <cmath>
#include <limits>

#include "rift/statistics/descriptive.hpp"

namespace rift::sweep {

gap::RepeatVerdict CountFailures(std::span<const TrialRow> rows, double confidence) {
  // Each row is a number above or below 0.5: it was judged by the threshold already.
  std::vector<double> failures;
  for (const TrialRow& row : rows) {
    if (row.IsOk() || row.falsified) failures.push_back(row.falsified ? 1.0 : 0.0);
  }
  return gap::JudgeRepeats(failures, 0.5, confidence);
}

namespace {

gap::Verdict Decide(const gap::RepeatVerdict& repeats, double share) {
  if (repeats.repeats == 0) return gap::Verdict::kUndecided;
  if (repeats.share_low > share) return gap::Verdict::kFalsified;
  if (repeats.share_high < share) return gap::Verdict::kNotFalsified;
  return gap::Verdict::kUndecided;
}

/// Gaps of the trials that tell; a fall that counts is above any threshold.
std::vector<double> Gaps(std::span<const TrialRow> rows, double fall_m) {
  std::vector<double> gaps_m;
  for (const TrialRow& row : rows) {
    if (row.IsOk()) {
      gaps_m.push_back(row.comparison.gap_m);
    } else if (row.falsified) {
      gaps_m.push_back(fall_m);
    }
  }
  return gaps_m;
}

}  // namespace

gap::Verdict JudgeSetting(std::span<const TrialRow> rows, const FalsifyOptions& options) {
  return Decide(CountFailures(rows, options.confidence), options.share);
}

double TrialsToFalsify(const FalsifyOptions& options) {
  if (options.share >= 1.0) return std::numeric_limits<double>::infinity();
  const double tail = (1.0 - options.confidence) / 2.0;
  // n failures of n: the lower bound is tail^(1/n) (Clopper and Pearson 1934).
  return std::floor(std::log(tail) / std::log(options.share)) + 1.0;
}

double Robustness_m(std::span<const TrialRow> rows, double threshold_m) {
  return threshold_m - statistics::Mean(Gaps(rows, 2.0 * threshold_m));
}

}  // namespace rift::sweep
