#include "rift/gap/result.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "rift/gap/comparison.hpp"
#include "rift/statistics/descriptive.hpp"

namespace rift::gap {

namespace {

// Logs are written to a micrometre or finer, and no two drives are that much alike.
constexpr double kCopy_m = 1e-5;

Verdict Decide(const RepeatVerdict& repeats, double needed_above, double needed_below) {
  if (repeats.evidence.above >= needed_above) return Verdict::kFalsified;
  if (repeats.evidence.below >= needed_below) return Verdict::kPassed;
  const bool is_doubtful = repeats.repeats == 0 || repeats.above > 0;
  return is_doubtful ? Verdict::kUndecided : Verdict::kNotSeenToFail;
}

double NeededEvidence(const std::vector<double>& evidence, int settings, double alpha) {
  const int discoveries = statistics::CountDiscoveries(evidence, settings, alpha);
  return statistics::NeededEvidence(settings, std::max(discoveries, 1), alpha);
}

}  // namespace

RepeatVerdict JudgeCounts(int above, int repeats, const VerdictOptions& options) {
  RepeatVerdict verdict{.above = above, .repeats = repeats, .confidence = options.confidence};
  const statistics::Interval share =
      statistics::AnytimeInterval(above, repeats, options.confidence);
  verdict.share_low = share.low;
  verdict.share_high = share.high;
  verdict.evidence = statistics::EvidenceOnShare(above, repeats, options.share);
  const double needed = statistics::NeededEvidence(1, 1, 1.0 - options.confidence);
  verdict.verdict = Decide(verdict, needed, needed);
  return verdict;
}

RepeatVerdict JudgeRepeats(std::span<const double> gaps_m, double threshold_m,
                           const VerdictOptions& options) {
  int above = 0, repeats = 0;
  for (const double gap_m : gaps_m) {
    if (std::isnan(gap_m)) continue;
    ++repeats;
    above += gap_m > threshold_m;
  }
  return JudgeCounts(above, repeats, options);
}

void JudgeTogether(std::span<RepeatVerdict> verdicts, int settings, const VerdictOptions& options) {
  std::vector<double> above, below;
  for (const RepeatVerdict& verdict : verdicts) {
    above.push_back(verdict.evidence.above);
    below.push_back(verdict.evidence.below);
  }
  const double alpha = 1.0 - options.confidence;
  const double needed_above = NeededEvidence(above, settings, alpha);
  const double needed_below = NeededEvidence(below, settings, alpha);
  for (RepeatVerdict& verdict : verdicts) {
    verdict.settings = settings;
    verdict.verdict = Decide(verdict, needed_above, needed_below);
  }
}

std::string VerdictText(const RepeatVerdict& verdict) {
  const std::string name(EnumNames(verdict.verdict)[static_cast<size_t>(verdict.verdict)]);
  const auto trials = [](int n) { return fmt::format("{} trial{}", n, n == 1 ? "" : "s"); };
  if (verdict.verdict == Verdict::kNotSeenToFail) {
    return fmt::format("{} ({})", name, trials(verdict.repeats));
  }
  if (verdict.verdict != Verdict::kUndecided) return name;
  if (verdict.repeats == 0) return name + " (no trial tells)";
  const double alone = statistics::NeededEvidence(1, 1, 1.0 - verdict.confidence);
  const char* why = verdict.evidence.above >= alone ? ", too few among so many settings" : "";
  return fmt::format("{} ({} of {} fail{}{})", name, verdict.above, trials(verdict.repeats),
                     verdict.repeats == 1 ? "s" : "", why);
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

std::vector<std::optional<size_t>> CopiesAmong(std::span<const trajectory::Trajectory> reals) {
  const auto are_same = [](const trajectory::Trajectory& a, const trajectory::Trajectory& b) {
    return std::equal(a.poses.begin(), a.poses.end(), b.poses.begin(), b.poses.end(),
                      [](const trajectory::StampedPose& p, const trajectory::StampedPose& q) {
                        const bool no_height = std::isnan(p.z_m) && std::isnan(q.z_m);
                        return (p.Position() - q.Position()).norm() <= kCopy_m &&
                               (no_height || std::abs(p.z_m - q.z_m) <= kCopy_m);
                      });
  };
  std::vector<std::optional<size_t>> copy_of(reals.size());
  for (size_t i = 0; i < reals.size(); ++i) {
    for (size_t j = 0; j < i && !copy_of[i]; ++j) {
      if (!copy_of[j] && are_same(reals[j], reals[i])) copy_of[i] = j;
    }
  }
  return copy_of;
}

std::vector<trajectory::Trajectory> Distinct(std::span<const trajectory::Trajectory> reals) {
  const std::vector<std::optional<size_t>> copy_of = CopiesAmong(reals);
  std::vector<trajectory::Trajectory> distinct;
  for (size_t i = 0; i < reals.size(); ++i) {
    if (!copy_of[i]) distinct.push_back(reals[i]);
  }
  return distinct;
}

void Judge(GapResult& result) {
  const std::vector<std::optional<size_t>> copy_of = CopiesAmong(result.reals);
  std::vector<double> gaps_m;
  double sum_m = 0.0;
  for (size_t i = 0; i < result.trials.size(); ++i) {
    const double gap_m = result.trials[i].comparison.gap_m;
    sum_m += gap_m;
    if (!copy_of[i]) gaps_m.push_back(gap_m);
  }
  result.mean_gap_m = sum_m / static_cast<double>(result.trials.size());
  result.noise_floor_m = NoiseFloor_m(Distinct(result.reals), result.options);
  result.verdict = JudgeRepeats(gaps_m, result.options.threshold_m, result.judged_by);
}

}  // namespace rift::gap
