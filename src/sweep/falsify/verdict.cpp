#include "rift/sweep/falsify/verdict.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "rift/statistics/descriptive.hpp"
#include "rift/sweep/falsify/distinct_rows.hpp"

namespace rift::sweep {
namespace {

std::vector<int> ThatTell(std::span<const TrialRow> rows) {
  std::vector<int> indices;
  for (size_t i = 0; i < rows.size(); ++i) {
    if (rows[i].Tells()) indices.push_back(static_cast<int>(i));
  }
  return indices;
}

bool HaveDifferentSeeds(std::span<const TrialRow> rows, const std::vector<int>& indices) {
  return std::any_of(indices.begin(), indices.end(), [&](int i) {
    return rows[i].seed && rows[i].seed != rows[indices.front()].seed;
  });
}

}  // namespace

gap::RepeatVerdict CountFailures(std::span<const TrialRow> rows, const gap::VerdictOptions& options,
                                 bool chance_repeats_runs) {
  const std::vector<int> indices = ThatTell(rows);
  const std::vector<int> distinct = DistinctRows(rows, indices, chance_repeats_runs);
  int above = 0;
  for (const int i : distinct) above += rows[i].falsified;
  gap::RepeatVerdict verdict = gap::JudgeCounts(above, static_cast<int>(distinct.size()), options);
  const bool is_without_chance =
      distinct.size() == 1 && indices.size() > 1 && HaveDifferentSeeds(rows, indices);
  if (is_without_chance) {
    constexpr double kSure = std::numeric_limits<double>::infinity();
    verdict.share_low = verdict.share_high = above;
    verdict.evidence = above > 0 ? statistics::ShareEvidence{kSure, -kSure}
                                 : statistics::ShareEvidence{-kSure, kSure};
    verdict.verdict = above > 0 ? gap::Verdict::kFalsified : gap::Verdict::kPassed;
  }
  return verdict;
}

int TrialsToFalsify(const gap::VerdictOptions& options, int settings) {
  const double needed = statistics::NeededEvidence(settings, 1, 1.0 - options.confidence);
  int trials = 1;
  while (statistics::EvidenceOnShare(trials, trials, options.share).above < needed) ++trials;
  return trials;
}

double Robustness_m(std::span<const TrialRow> rows, double threshold_m) {
  std::vector<double> losses_m;
  for (const TrialRow& row : rows) losses_m.push_back(Loss_m(row, threshold_m));
  return threshold_m - statistics::MeanOfKnown(losses_m);
}

double RepeatPlan::Least() const {
  return statistics::NeededEvidence(1, 1, 1.0 - options_.confidence);
}

void RepeatPlan::Evidence::Note(const gap::RepeatVerdict& verdict, double least) {
  if (verdict.evidence.above >= least) above.push_back(verdict.evidence.above);
  if (verdict.evidence.below >= least) below.push_back(verdict.evidence.below);
}

double RepeatPlan::Needed(std::vector<double> evidence) const {
  const double alpha = 1.0 - options_.confidence;
  const int discoveries = statistics::CountDiscoveries(std::move(evidence), settings_, alpha);
  return statistics::NeededEvidence(settings_, std::min(discoveries + 1, settings_), alpha);
}

int RepeatPlan::Worth(std::span<const TrialRow> rows, const gap::RepeatVerdict& verdict,
                      double above, double below) const {
  if (verdict.evidence.above >= above || verdict.evidence.below >= below) return 0;
  // Trials that do not tell are replaced, but not where most of them do not.
  constexpr int kMostLost = 2;
  const int told = static_cast<int>(ThatTell(rows).size());
  if (static_cast<int>(rows.size()) - told > kMostLost + told) return 0;
  if (told == 0) return 1;
  for (int more = 1; told + more <= options_.most_repeats; ++more) {
    const int n = verdict.repeats + more;
    const bool may_decide =
        statistics::EvidenceOnShare(verdict.above + more, n, options_.share).above >= above ||
        statistics::EvidenceOnShare(verdict.above, n, options_.share).below >= below;
    if (may_decide) return more;
  }
  return 0;
}

void RepeatPlan::LookForChance(const Settings& batch) {
  for (const std::span<const TrialRow> rows : batch) {
    std::vector<const TrialRow*> trials;
    for (const TrialRow& row : rows) trials.push_back(&row);
    chance_.Note(trials);
  }
  if (!chance_.IsSeen()) return;
  const auto is_without_chance = [](double evidence) { return std::isinf(evidence); };
  std::erase_if(done_.above, is_without_chance);
  std::erase_if(done_.below, is_without_chance);
}

std::vector<int> RepeatPlan::More(const Settings& batch) {
  LookForChance(batch);
  Evidence evidence = done_;
  std::vector<gap::RepeatVerdict> verdicts;
  for (const std::span<const TrialRow> rows : batch) {
    verdicts.push_back(CountFailures(rows, options_, chance_.IsSeen()));
    evidence.Note(verdicts.back(), Least());
  }
  const double above = Needed(std::move(evidence.above));
  const double below = Needed(std::move(evidence.below));
  std::vector<int> more(batch.size(), 0);
  for (size_t i = 0; i < batch.size(); ++i) {
    const gap::RepeatVerdict& verdict = verdicts[i];
    const bool is_far = std::abs(Robustness_m(batch[i], threshold_m_)) > options_.near_m;
    const bool is_doubtful = verdict.above > 0 || (verdict.repeats <= 1 && !is_far);
    const bool is_meant =
        options_.repeat == Repeat::kEvery || (options_.repeat == Repeat::kDoubtful && is_doubtful);
    if (is_meant) more[i] = Worth(batch[i], verdict, above, below);
  }
  return more;
}

void RepeatPlan::Add(const Settings& batch) {
  LookForChance(batch);
  for (const std::span<const TrialRow> rows : batch) {
    done_.Note(CountFailures(rows, options_, chance_.IsSeen()), Least());
  }
}

bool RepeatPlan::HasFalsified() const {
  return statistics::CountDiscoveries(done_.above, settings_, 1.0 - options_.confidence) > 0;
}

}  // namespace rift::sweep
