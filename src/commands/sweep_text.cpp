#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "rift/report/figures/sweep_figures.hpp"
#include "rift/sweep/falsify/labels.hpp"
#include "sweep_output.hpp"

namespace rift::commands {
namespace {

/// Of a long table the values with the largest means, since a terminal is not for thousands.
std::string LevelTable(const std::string& head, std::vector<sweep::LevelSummary> levels) {
  constexpr size_t kMostLevels = 40;
  const size_t omitted = levels.size() - std::min(levels.size(), kMostLevels);
  if (omitted > 0) {
    std::stable_sort(levels.begin(), levels.end(), [](const auto& a, const auto& b) {
      return std::isnan(b.mean_gap_m) ? !std::isnan(a.mean_gap_m) : a.mean_gap_m > b.mean_gap_m;
    });
    levels.resize(kMostLevels);
  }
  size_t width = head.size();
  for (const sweep::LevelSummary& level : levels) width = std::max(width, level.level.size());
  std::string text =
      fmt::format("{:<{}}  mean_gap_m  failures  trials  without_gap\n", head, width);
  for (const sweep::LevelSummary& level : levels) {
    const std::string mean =
        std::isnan(level.mean_gap_m) ? "-" : fmt::format("{:.4f}", level.mean_gap_m);
    text += fmt::format("{:<{}}  {:>10}  {:>8}  {:>6}  {:>11}\n", level.level, width, mean,
                        level.failures, level.n, level.not_ok);
  }
  if (omitted > 0) text += fmt::format("and {} more, all of them in summary.json\n", omitted);
  return text + '\n';
}

int CountVerdict(const sweep::SweepResult& result, gap::Verdict verdict) {
  return static_cast<int>(std::count_if(
      result.settings.begin(), result.settings.end(),
      [&](const sweep::SettingResult& setting) { return setting.verdict.verdict == verdict; }));
}

std::string EffectsText(const sweep::SweepResult& result) {
  std::string text;
  for (const sweep::Effect& effect : result.effects) {
    text += fmt::format("{}: {}\n", effect.parameter, effect.sentence);
  }
  return text;
}

std::string WorstText(const sweep::SweepResult& result) {
  const std::optional<int> index = report::WorstRow(result);
  if (!index) return "";
  const sweep::TrialRow& worst = result.rows[*index];
  return fmt::format("worst: {:.4f} m at u = {:.2f} ({}, trial {})\n", worst.comparison.gap_m,
                     worst.comparison.gap_u, sweep::SettingText(result.parameters, worst.theta),
                     worst.trial);
}

std::string NotOkText(const sweep::SweepResult& result) {
  constexpr int kMostShown = 3;
  std::string text;
  int shown = 0;
  for (const sweep::TrialRow& row : result.rows) {
    if (row.IsOk() || ++shown > kMostShown) continue;
    text += fmt::format("without gap: {}\n", row.reason);
  }
  if (shown > kMostShown) text += fmt::format("without gap: {} more\n", shown - kMostShown);
  return text;
}

std::string FalsificationText(const sweep::SweepResult& result, const sweep::Falsification& found) {
  std::string text = fmt::format(
      "{}: {} settings falsified and {} undecided of {} tried ({}, ended by {}); falsified: more "
      "than {:.0f} % of its trials would fail, at {:g} % confidence\n",
      EnumNames(found.verdict)[static_cast<size_t>(found.verdict)], found.falsified,
      found.undecided, found.evaluations, found.strategy, found.ended, 100.0 * found.share,
      100.0 * found.confidence);
  if (found.first_evaluation) {
    text += fmt::format("first falsified setting: number {}\n", *found.first_evaluation);
  }
  if (found.worst_setting) {
    const sweep::SettingResult& worst = result.settings.at(*found.worst_setting);
    text += fmt::format("worst setting: mean gap {:.4f} m in {} trials, {} of them failed ({})\n",
                        worst.mean_gap_m, worst.rows.size(), worst.verdict.above,
                        sweep::SettingText(result.parameters, worst.theta));
  }
  return text;
}

/// The table of a parameter, unless every setting has a value of its own.
std::string LevelTables(const sweep::SweepResult& result) {
  const sweep::FactorSplit split = sweep::SplitFactors(result.parameters);
  const auto is_range = [&](int i) { return result.parameters[i].IsContinuous(); };
  std::string text;
  if (!is_range(split.main_factor)) {
    text += LevelTable(result.parameters[split.main_factor].Name(),
                       sweep::SummariseBy(result, {split.main_factor}));
  }
  const bool has_range = std::any_of(split.others.begin(), split.others.end(), is_range);
  if (!split.others.empty() && !has_range) {
    text += LevelTable(split.others_name, sweep::SummariseBy(result, split.others));
  }
  return text;
}

}  // namespace

std::string SweepText(const sweep::SweepResult& result) {
  std::string text =
      fmt::format("gap: {}; above {:g} m falsifies\n\n",
                  gap::DefinitionText(result.gap, result.tag_offset_m), result.gap.threshold_m);
  if (!result.parameters.empty()) text += LevelTables(result);
  text += LevelTable("", {result.all});
  text += EffectsText(result) + WorstText(result) + NotOkText(result);
  if (result.falsification) return text + FalsificationText(result, *result.falsification);
  text += fmt::format("settings: {} falsified, {} not, {} undecided (their repeats disagree)\n",
                      CountVerdict(result, gap::Verdict::kFalsified),
                      CountVerdict(result, gap::Verdict::kNotFalsified),
                      CountVerdict(result, gap::Verdict::kUndecided));
  return text;
}

}  // namespace rift::commands
