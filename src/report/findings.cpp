#include "findings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "gnuplot_text.hpp"
#include "rift/report/sweep_figures.hpp"
#include "rift/sweep/labels.hpp"
#include "setting_grid.hpp"

namespace rift::report {
namespace {

std::string Metres(double value_m) { return fmt::format("{:.4f} m", value_m); }
std::string Percent(double share) { return fmt::format("{:.0f} %", 100.0 * share); }

std::string Count(long n, std::string_view noun) {
  return fmt::format("{} {}{}", n, noun, n == 1 ? "" : "s");
}

struct Mean {
  double sum = 0.0;
  long n = 0;

  void Add(double value) {
    if (!std::isfinite(value)) return;
    sum += value;
    ++n;
  }
  double Value() const { return n == 0 ? NAN : sum / static_cast<double>(n); }
};

template <class Field>
double MeanOverTrials(const sweep::SweepResult& result, Field field) {
  Mean mean;
  for (const sweep::TrialRow& row : result.rows) {
    if (row.IsOk()) mean.Add(row.comparison.*field);
  }
  return mean.Value();
}

double FailureShare(const sweep::LevelSummary& level) {
  return level.n == 0 ? -1.0 : static_cast<double>(level.failures) / level.n;
}

std::string LevelText(const sweep::LevelSummary& level) {
  return fmt::format("{} ({} of {} trials)", level.level, level.failures, level.n);
}

// The levels of the main factor with the largest and the smallest share of failures.
std::string MostAndLeast(const sweep::SweepResult& result) {
  const int main = sweep::SplitFactors(result.parameters).main_factor;
  if (result.parameters[main].IsContinuous()) return "";
  std::vector<sweep::LevelSummary> levels = sweep::SummariseBy(result, {main});
  std::erase_if(levels, [](const auto& level) { return level.n == 0; });
  if (levels.size() < 2) return "";
  const auto [least, most] =
      std::minmax_element(levels.begin(), levels.end(), [](const auto& a, const auto& b) {
        return std::pair(FailureShare(a), a.mean_gap_m) < std::pair(FailureShare(b), b.mean_gap_m);
      });
  return fmt::format("Most often at {} {}, least often at {}.", result.parameters[main].Name(),
                     LevelText(*most), LevelText(*least));
}

Finding Where(const sweep::SweepResult& result) {
  Finding finding{"Where is it worst?", {}};
  const std::optional<int> worst = WorstRow(result);
  if (!worst) {
    finding.sentences.push_back("Not known: no trial has a gap.");
    return finding;
  }
  if (!result.parameters.empty() && result.all.failures > 0) {
    const std::string levels = MostAndLeast(result);
    if (!levels.empty()) finding.sentences.push_back(levels);
  }
  const sweep::TrialRow& row = result.rows[*worst];
  finding.sentences.push_back(
      fmt::format("The largest gap, {}, is {}, trial {}, at u = {:.2f} of "
                  "the path.",
                  Metres(row.comparison.gap_m), SettingLabel(result, row.theta), row.trial,
                  row.comparison.gap_u));
  for (const sweep::SettingResult* setting : WorstSettings(result)) {
    if (!std::isfinite(setting->mean_gap_m)) continue;
    finding.sentences.push_back(fmt::format(
        "The worst setting on average is {}, {} over {}.", SettingLabel(result, setting->theta),
        Metres(setting->mean_gap_m), Count(setting->verdict.repeats, "trial")));
    break;
  }
  return finding;
}

Finding Because(const sweep::SweepResult& result) {
  Finding finding{"Because of what?", {}};
  for (const sweep::Effect& effect : result.effects) {
    finding.sentences.push_back(fmt::format("{}: {}.", effect.parameter, effect.sentence));
  }
  if (finding.sentences.empty()) {
    finding.sentences.push_back("Not known: no parameter was varied over comparable values.");
  }
  return finding;
}

struct Verdicts {
  int falsified = 0, held = 0, disagree = 0, unmeasured = 0;
  const gap::RepeatVerdict* unanimous = nullptr;  ///< of the most repeats
};

Verdicts CountVerdicts(const sweep::SweepResult& result) {
  Verdicts verdicts;
  for (const sweep::SettingResult& setting : result.settings) {
    const gap::RepeatVerdict& verdict = setting.verdict;
    if (verdict.verdict == gap::Verdict::kUndecided) {
      ++(verdict.repeats == 0 ? verdicts.unmeasured : verdicts.disagree);
      continue;
    }
    ++(verdict.verdict == gap::Verdict::kFalsified ? verdicts.falsified : verdicts.held);
    if (verdicts.unanimous == nullptr || verdict.repeats > verdicts.unanimous->repeats) {
      verdicts.unanimous = &verdict;
    }
  }
  return verdicts;
}

Finding HowSure(const sweep::SweepResult& result) {
  const Verdicts verdicts = CountVerdicts(result);
  Finding finding{"How sure is that?", {}};
  finding.sentences.push_back(fmt::format(
      "Of {}, {} falsified, {} not falsified and {} undecided because the repeats disagree.",
      Count(static_cast<long>(result.settings.size()), "setting"), verdicts.falsified,
      verdicts.held, verdicts.disagree));
  if (verdicts.unmeasured > 0) {
    finding.sentences.push_back(fmt::format("{} undecided because no repeat has a gap.",
                                            Count(verdicts.unmeasured, "setting")));
  }
  if (verdicts.unanimous != nullptr) {
    const gap::RepeatVerdict& verdict = *verdicts.unanimous;
    const std::string repeats =
        verdict.repeats == 1 ? std::string("From a single repeat,")
                             : fmt::format("Even where all {} repeats agree,", verdict.repeats);
    finding.sentences.push_back(
        fmt::format("{} the share of such trials above the threshold is known only to "
                    "lie between {} and {} ({} confidence).",
                    repeats, Percent(verdict.share_low), Percent(verdict.share_high),
                    Percent(verdict.confidence)));
  }
  return finding;
}

Finding BesideNoise(const sweep::SweepResult& result) {
  Finding finding{"How much is the robot's own scatter?", {}};
  Mean floor;
  for (const sweep::SettingResult& setting : result.settings) floor.Add(setting.noise_floor_m);
  if (floor.n == 0) {
    finding.sentences.push_back(
        "Not known: no setting has two references to compare with each other.");
    return finding;
  }
  finding.sentences.push_back(fmt::format(
      "Repeats of one setting are {} apart from each other (noise floor, mean of {}); the mean gap "
      "to the candidate is {}, {:.2f} times that.",
      Metres(floor.Value()), Count(floor.n, "setting"), Metres(result.all.mean_gap_m),
      result.all.mean_gap_m / floor.Value()));
  return finding;
}

Finding StartShare(const sweep::SweepResult& result) {
  Finding finding{"How much is only the start pose?", {}};
  const double gap_m = MeanOverTrials(result, &gap::Comparison::gap_m);
  const double aligned_m = MeanOverTrials(result, &gap::Comparison::start_aligned_gap_m);
  const double shape_m = MeanOverTrials(result, &gap::Comparison::shape_gap_m);
  if (!std::isfinite(aligned_m) || !std::isfinite(shape_m)) {
    finding.sentences.push_back("Not known: no trial has a gap.");
    return finding;
  }
  const double change = (aligned_m - gap_m) / gap_m;
  finding.sentences.push_back(fmt::format(
      "Mean gap {}; with the first points laid together {} ({:+.0f} %); {} is shape, left after "
      "the best rigid motion.",
      Metres(gap_m), Metres(aligned_m), 100.0 * change, Metres(shape_m)));
  return finding;
}

Finding NotMeasuredFinding(const sweep::SweepResult& result) {
  Finding finding{"What was not measured?", {}};
  if (result.all.not_ok == 0) {
    finding.sentences.push_back(fmt::format("Nothing: all {} have a gap.",
                                            Count(static_cast<long>(result.rows.size()), "trial")));
    return finding;
  }
  std::string kinds;
  for (const sweep::TrialStatus status :
       {sweep::TrialStatus::kMissing, sweep::TrialStatus::kUnreadable}) {
    const long n = std::count_if(result.rows.begin(), result.rows.end(),
                                 [status](const auto& row) { return row.status == status; });
    if (n == 0) continue;
    kinds += fmt::format("{}{} {}", kinds.empty() ? "" : ", ", n,
                         EnumNames(status)[static_cast<int>(status)]);
  }
  finding.sentences.push_back(
      fmt::format("Without a gap: {} of {} ({}). They are in no mean on this page.",
                  result.all.not_ok, Count(static_cast<long>(result.rows.size()), "trial"), kinds));
  const long fewer =
      std::count_if(result.settings.begin(), result.settings.end(), [&](const auto& setting) {
        return setting.verdict.repeats > 0 && NotMeasured(result, setting) > 0;
      });
  if (fewer > 0) {
    finding.sentences.push_back(
        fmt::format("{} judged by fewer repeats than asked for.", Count(fewer, "setting")));
  }
  return finding;
}

}  // namespace

Headline Summary(const sweep::SweepResult& result) {
  const std::string threshold = Number(result.gap.threshold_m);
  const sweep::LevelSummary& all = result.all;
  if (all.n == 0) return {Outcome::kUnknown, "Not known whether it fails: no trial has a gap."};
  if (all.failures == 0) {
    return {Outcome::kHolds,
            fmt::format("No failure: none of {} exceeds {} m; mean gap {}.",
                        Count(all.n, "measured trial"), threshold, Metres(all.mean_gap_m))};
  }
  return {Outcome::kFails, fmt::format("It fails: {} of {} exceed {} m ({}); mean gap {}.",
                                       all.failures, Count(all.n, "measured trial"), threshold,
                                       Percent(FailureShare(all)), Metres(all.mean_gap_m))};
}

std::vector<Finding> Findings(const sweep::SweepResult& result) {
  return {Where(result),       Because(result),    HowSure(result),
          BesideNoise(result), StartShare(result), NotMeasuredFinding(result)};
}

std::vector<std::string> UnmeasuredTrials(const sweep::SweepResult& result) {
  std::vector<std::string> lines;
  for (const sweep::TrialRow& row : result.rows) {
    if (row.IsOk()) continue;
    lines.push_back(fmt::format("{}, trial {}: {} – {}", SettingLabel(result, row.theta), row.trial,
                                EnumNames(row.status)[static_cast<int>(row.status)], row.reason));
  }
  return lines;
}

}  // namespace rift::report
