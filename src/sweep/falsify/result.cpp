#include "rift/sweep/falsify/result.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <stdexcept>

#include "rift/statistics/descriptive.hpp"
#include "rift/statistics/inference.hpp"
#include "rift/sweep/falsify/chance_among_runs.hpp"
#include "rift/sweep/falsify/distinct_rows.hpp"
#include "rift/sweep/falsify/doubts.hpp"
#include "rift/sweep/falsify/verdict.hpp"
#include "rift/trajectory/csv.hpp"

namespace rift::sweep {

FactorSplit SplitFactors(const std::vector<experiment::Parameter>& parameters) {
  if (parameters.empty()) throw std::invalid_argument("the space has no parameters");
  const auto categorical = std::find_if(
      parameters.begin(), parameters.end(),
      [](const experiment::Parameter& parameter) { return parameter.IsCategorical(); });
  FactorSplit split;
  if (categorical != parameters.end()) {
    split.main_factor = static_cast<int>(categorical - parameters.begin());
  }
  for (int i = 0; i < static_cast<int>(parameters.size()); ++i) {
    if (i == split.main_factor) continue;
    split.others.push_back(i);
    split.others_name += (split.others_name.empty() ? "" : ", ") + parameters[i].Name();
  }
  if (split.others.size() > 1) split.others_name = "[" + split.others_name + "]";
  return split;
}

bool HasLevels(const experiment::Parameter& parameter) {
  if (!parameter.IsContinuous()) return true;
  return parameter.is_integer &&
         std::floor(parameter.max) - std::ceil(parameter.min) < kMostWholeLevels;
}

std::string PercentDigits(double share) {
  constexpr double kNoise = 1e-5;  // of a per cent: one run of millions is more
  const double percent = 100.0 * share;
  const double to_end = std::min(percent, 100.0 - percent);
  const bool is_near_end = to_end >= kNoise && to_end < 1.0;
  const int digits =
      is_near_end ? std::max(2, static_cast<int>(std::ceil(-std::log10(to_end)))) : 0;
  return fmt::format("{:.{}f}", percent, digits);
}

std::string PercentText(double share) { return PercentDigits(share) + " %"; }

std::string ShortText(const experiment::Parameter& parameter,
                      const experiment::ParameterValue& value) {
  const bool is_drawn = parameter.IsContinuous() && value.number;
  if (!is_drawn) return value.text;
  // Four digits of the range: of values that agree in their first ones these tell nothing.
  const double way = parameter.max - parameter.min;
  const double larger = std::max({std::abs(parameter.min), std::abs(parameter.max), way});
  const int shared = way > 0.0 ? static_cast<int>(std::log10(larger / way)) : 0;
  return fmt::format("{:.{}g}", *value.number, std::min(17, 4 + shared));
}

std::string SettingText(const std::vector<experiment::Parameter>& parameters,
                        const experiment::Theta& theta) {
  std::string text;
  for (size_t i = 0; i < parameters.size(); ++i) {
    text += fmt::format("{}{} {}", i == 0 ? "" : ", ", parameters[i].Name(),
                        ShortText(parameters[i], theta[i]));
  }
  return text.empty() ? "the only setting" : text;
}

std::string CombinationLabel(const experiment::Theta& theta, const std::vector<int>& parameters) {
  if (parameters.size() == 1) return theta[parameters.front()].text;
  std::string label;
  for (const int i : parameters)
    label += (label.empty() ? "" : ", ") + trajectory::csv::Cell(theta[i].text);
  return "[" + label + "]";
}

std::string MainLevel(const std::vector<experiment::Parameter>& parameters,
                      const experiment::Theta& theta) {
  return parameters.empty() ? "" : theta[SplitFactors(parameters).main_factor].text;
}

double Loss_m(const TrialRow& row, double threshold_m) {
  if (row.IsOk()) return row.CountedGap_m();
  if (!row.falsified) return gap::kNotComputed;
  return threshold_m + (std::isfinite(row.left_m) ? row.left_m : threshold_m);
}

int SweepResult::Count(gap::Verdict verdict) const {
  return static_cast<int>(std::count_if(
      settings.begin(), settings.end(),
      [verdict](const SettingResult& setting) { return setting.verdict.verdict == verdict; }));
}

namespace {

/// Indices of rows by the label of their group, groups in the order of their first row.
struct Groups {
  std::vector<std::string> labels;
  std::vector<std::vector<int>> rows;
};

/// Values that tell a row's group; labels would not do, since one may contain another's comma.
experiment::Theta Part(const experiment::Theta& theta, const std::vector<int>& parameters) {
  experiment::Theta part;
  for (const int i : parameters) part.push_back(theta[i]);
  return part;
}

Groups GroupBy(const SweepResult& result, const std::vector<int>& parameters) {
  Groups groups;
  std::map<experiment::Theta, size_t> index_of;
  for (size_t row = 0; row < result.rows.size(); ++row) {
    const auto [found, is_new] =
        index_of.emplace(Part(result.rows[row].theta, parameters), groups.labels.size());
    if (is_new) {
      groups.labels.push_back(CombinationLabel(result.rows[row].theta, parameters));
      groups.rows.emplace_back();
    }
    groups.rows[found->second].push_back(static_cast<int>(row));
  }
  return groups;
}

/// That of their first rows; of a range of whole numbers, which a search visits in any order,
/// theirs.
std::vector<size_t> OrderOf(const Groups& groups, const SweepResult& result,
                            const std::vector<int>& parameters) {
  std::vector<size_t> order(groups.labels.size());
  std::iota(order.begin(), order.end(), size_t{0});
  if (parameters.size() != 1) return order;
  const experiment::Parameter& parameter = result.parameters[parameters.front()];
  if (!parameter.IsContinuous() || !HasLevels(parameter)) return order;
  const auto number = [&](size_t group) {
    return result.rows[groups.rows[group].front()].theta[parameters.front()].number.value_or(0.0);
  };
  std::stable_sort(order.begin(), order.end(),
                   [&](size_t a, size_t b) { return number(a) < number(b); });
  return order;
}

std::vector<double> GapsOf(const SweepResult& result, const std::vector<int>& rows) {
  std::vector<double> gaps_m;
  for (const int row : rows) {
    if (result.rows[row].IsOk()) gaps_m.push_back(result.rows[row].comparison.gap_m);
  }
  return gaps_m;
}

/// Of the distinct trials that tell.
std::vector<double> LossesOf(const SweepResult& result, const std::vector<int>& rows) {
  std::vector<double> losses_m;
  for (const int row : DistinctRows(result.rows, rows, result.chance_repeats_runs)) {
    const double loss_m = Loss_m(result.rows[row], result.gap.threshold_m);
    if (std::isfinite(loss_m)) losses_m.push_back(loss_m);
  }
  return losses_m;
}

LevelSummary SummariseRows(const SweepResult& result, const std::string& level,
                           const std::vector<int>& rows) {
  const std::vector<double> gaps_m = GapsOf(result, rows);
  LevelSummary summary{.level = level, .n = static_cast<int>(gaps_m.size())};
  for (const int row : rows) {
    summary.failures += result.rows[row].falsified;
    summary.told += result.rows[row].Tells();
    summary.not_ok += !result.rows[row].IsOk();
  }
  summary.mean_gap_m = statistics::Mean(gaps_m);
  summary.sd_gap_m = statistics::StandardDeviation(gaps_m);
  return summary;
}

Anova AnovaOf(const SweepResult& result, int parameter) {
  const Groups groups = GroupBy(result, {parameter});
  std::vector<std::vector<double>> losses_m;
  for (const std::vector<int>& rows : groups.rows) losses_m.push_back(LossesOf(result, rows));
  const statistics::AnalysisOfVariance analysis = statistics::AnalyseVariance(losses_m);
  return {.parameter = result.parameters[parameter].Name(),
          .levels = SummariseBy(result, {parameter}),
          .f = analysis.f,
          .df_between = analysis.df_between,
          .df_within = analysis.df_within,
          .p = analysis.p,
          .eta_squared = analysis.eta_squared,
          .omega_squared = analysis.omega_squared};
}

/// Indices of the rows of each setting.
std::vector<std::vector<int>> RowsBySetting(const SweepResult& result) {
  std::vector<int> all(result.parameters.size());
  std::iota(all.begin(), all.end(), 0);
  return GroupBy(result, all).rows;
}

bool HasChanceAmongRuns(const SweepResult& result,
                        const std::vector<std::vector<int>>& by_setting) {
  ChanceAmongRuns chance;
  for (const std::vector<int>& rows : by_setting) {
    std::vector<const TrialRow*> trials;
    for (const int row : rows) trials.push_back(&result.rows[row]);
    chance.Note(trials);
  }
  return chance.IsSeen();
}

std::vector<SettingResult> SettingsOf(const SweepResult& result,
                                      std::vector<std::vector<int>> by_setting) {
  std::vector<SettingResult> settings;
  for (std::vector<int>& rows : by_setting) {
    const double mean_gap_m = statistics::Mean(GapsOf(result, rows));
    const std::vector<double> losses_m = LossesOf(result, rows);
    std::vector<TrialRow> trials;
    for (const int row : rows) trials.push_back(result.rows[row]);
    SettingResult setting{
        .theta = trials.front().theta,
        .rows = std::move(rows),
        .mean_gap_m = mean_gap_m,
        .mean_loss_m = statistics::Mean(losses_m),
        .loss_m = statistics::MeanInterval(losses_m, 0.95),
        .verdict = CountFailures(trials, result.judged_by, result.chance_repeats_runs)};
    settings.push_back(std::move(setting));
  }
  return settings;
}

void JudgeSettings(SweepResult& result) {
  std::vector<gap::RepeatVerdict> verdicts;
  for (const SettingResult& setting : result.settings) verdicts.push_back(setting.verdict);
  const int settings = std::max(result.judged_settings, static_cast<int>(verdicts.size()));
  gap::JudgeTogether(verdicts, settings, result.judged_by);
  for (size_t i = 0; i < verdicts.size(); ++i) result.settings[i].verdict = verdicts[i];
}

}  // namespace

std::vector<LevelSummary> SummariseBy(const SweepResult& result,
                                      const std::vector<int>& parameters) {
  const Groups groups = GroupBy(result, parameters);
  std::vector<LevelSummary> summaries;
  for (const size_t i : OrderOf(groups, result, parameters)) {
    summaries.push_back(SummariseRows(result, groups.labels[i], groups.rows[i]));
  }
  return summaries;
}

void Summarise(SweepResult& result) {
  std::vector<int> every_row(result.rows.size());
  std::iota(every_row.begin(), every_row.end(), 0);
  result.all = SummariseRows(result, "all", every_row);
  std::vector<std::vector<int>> by_setting = RowsBySetting(result);
  result.chance_repeats_runs = result.chance_repeats_runs || HasChanceAmongRuns(result, by_setting);
  result.settings = SettingsOf(result, std::move(by_setting));
  JudgeSettings(result);
  result.anova.clear();
  for (size_t i = 0; i < result.parameters.size(); ++i) {
    const experiment::Parameter& parameter = result.parameters[i];
    if (parameter.levels.size() > 1) result.anova.push_back(AnovaOf(result, static_cast<int>(i)));
  }
  result.doubts = DoubtsOf(result);
}

std::vector<const SettingResult*> WorstSettings(const SweepResult& result) {
  std::vector<const SettingResult*> settings;
  for (const SettingResult& setting : result.settings) settings.push_back(&setting);
  const auto rank = [](const SettingResult* setting) {
    const gap::RepeatVerdict& verdict = setting->verdict;
    const double share = static_cast<double>(verdict.above) / std::max(1, verdict.repeats);
    const bool is_known = std::isfinite(setting->mean_loss_m);
    return std::pair(share,
                     is_known ? setting->mean_loss_m : std::numeric_limits<double>::infinity());
  };
  std::stable_sort(settings.begin(), settings.end(),
                   [&](const auto* a, const auto* b) { return rank(a) > rank(b); });
  return settings;
}

std::optional<int> WorstRow(const SweepResult& result) {
  std::optional<int> worst;
  for (std::size_t i = 0; i < result.rows.size(); ++i) {
    if (!result.rows[i].IsOk()) continue;
    if (!worst || result.rows[i].comparison.gap_m > result.rows[*worst].comparison.gap_m) {
      worst = static_cast<int>(i);
    }
  }
  return worst;
}

}  // namespace rift::sweep
