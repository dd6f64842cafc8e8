#include "rift/sweep/falsify/summary.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <map>
#include <numeric>

#include "rift/statistics/analysis_of_variance.hpp"
#include "rift/statistics/mean.hpp"
#include "rift/sweep/falsify/labels.hpp"

namespace rift::sweep {
namespace {

/// Indices of rows by the label of their group, groups in the order of their first row.
struct Groups {
  std::vector<std::string> labels;
  std::vector<std::vector<int>> rows;
};

/// Values of a row that tell its group; labels would not do, since one may contain another's comma.
std::vector<std::string> KeyOf(const TrialRow& row, const std::vector<int>& parameters) {
  std::vector<std::string> key;
  for (const int i : parameters) key.push_back(row.theta[i].text);
  return key;
}

Groups GroupBy(const SweepResult& result, const std::vector<int>& parameters) {
  Groups groups;
  std::map<std::vector<std::string>, size_t> index_of;
  for (size_t row = 0; row < result.rows.size(); ++row) {
    const auto [found, is_new] =
        index_of.emplace(KeyOf(result.rows[row], parameters), groups.labels.size());
    if (is_new) {
      groups.labels.push_back(CombinationLabel(result.rows[row].theta, parameters));
      groups.rows.emplace_back();
    }
    groups.rows[found->second].push_back(static_cast<int>(row));
  }
  return groups;
}

std::vector<double> GapsOf(const SweepResult& result, const std::vector<int>& rows) {
  std::vector<double> gaps_m;
  for (const int row : rows) {
    if (result.rows[row].IsOk()) gaps_m.push_back(result.rows[row].comparison.gap_m);
  }
  return gaps_m;
}

/// A fall that counts is above any threshold.
std::vector<double> GapsToJudge(const SweepResult& result, const std::vector<int>& rows) {
  std::vector<double> gaps_m = GapsOf(result, rows);
  for (const int row : rows) {
    const bool is_fall = !result.rows[row].IsOk() && result.rows[row].falsified;
    if (is_fall) gaps_m.push_back(std::numeric_limits<double>::infinity());
  }
  return gaps_m;
}

LevelSummary SummariseRows(const SweepResult& result, const std::string& level,
                           const std::vector<int>& rows) {
  const std::vector<double> gaps_m = GapsOf(result, rows);
  LevelSummary summary{.level = level, .n = static_cast<int>(gaps_m.size())};
  for (const int row : rows) {
    summary.failures += result.rows[row].falsified;
    summary.not_ok += !result.rows[row].IsOk();
  }
  summary.mean_gap_m = statistics::Mean(gaps_m);
  summary.sd_gap_m = statistics::StandardDeviation(gaps_m);
  return summary;
}

std::string EffectSentence(const Effect& effect) {
  if (std::isnan(effect.p) && effect.df_within >= 1.0 && effect.df_between >= 1.0) {
    return "no test possible: the trials of each value do not differ";
  }
  if (std::isnan(effect.p)) return "no test possible: too few trials with a gap";
  const std::string p = effect.p < 0.001 ? "p < 0.001" : fmt::format("p = {:.3f}", effect.p);
  if (!effect.detected) return fmt::format("no effect found ({})", p);
  return fmt::format("effect found (F = {:.1f}, {}, {:.0f} % of the variance)", effect.f, p,
                     100.0 * effect.eta_squared);
}

Effect EffectOf(const SweepResult& result, int parameter) {
  const Groups groups = GroupBy(result, {parameter});
  std::vector<std::vector<double>> gaps_m;
  for (const std::vector<int>& rows : groups.rows) gaps_m.push_back(GapsOf(result, rows));
  const statistics::AnalysisOfVariance analysis = statistics::AnalyseVariance(gaps_m);
  Effect effect{.parameter = result.parameters[parameter].Name(),
                .levels = SummariseBy(result, {parameter}),
                .f = analysis.f,
                .df_between = analysis.df_between,
                .df_within = analysis.df_within,
                .p = analysis.p,
                .eta_squared = analysis.eta_squared,
                .omega_squared = analysis.omega_squared,
                .detected = analysis.p < kSignificance};
  effect.sentence = EffectSentence(effect);
  return effect;
}

std::vector<SettingResult> SettingsOf(const SweepResult& result) {
  std::vector<int> all(result.parameters.size());
  std::iota(all.begin(), all.end(), 0);
  std::vector<SettingResult> settings;
  for (std::vector<int>& rows : GroupBy(result, all).rows) {
    const double mean_gap_m = statistics::Mean(GapsOf(result, rows));
    const std::vector<double> gaps_m = GapsToJudge(result, rows);
    SettingResult setting{.theta = result.rows[rows.front()].theta,
                          .rows = std::move(rows),
                          .mean_gap_m = mean_gap_m,
                          .verdict = gap::JudgeRepeats(gaps_m, result.gap.threshold_m)};
    settings.push_back(std::move(setting));
  }
  return settings;
}

}  // namespace

std::vector<LevelSummary> SummariseBy(const SweepResult& result,
                                      const std::vector<int>& parameters) {
  const Groups groups = GroupBy(result, parameters);
  std::vector<LevelSummary> summaries;
  for (size_t i = 0; i < groups.labels.size(); ++i) {
    summaries.push_back(SummariseRows(result, groups.labels[i], groups.rows[i]));
  }
  return summaries;
}

void Summarise(SweepResult& result) {
  std::vector<int> every_row(result.rows.size());
  std::iota(every_row.begin(), every_row.end(), 0);
  result.all = SummariseRows(result, "all", every_row);
  result.settings = SettingsOf(result);
  result.effects.clear();
  for (size_t i = 0; i < result.parameters.size(); ++i) {
    const experiment::Parameter& parameter = result.parameters[i];
    if (parameter.levels.size() > 1)
      result.effects.push_back(EffectOf(result, static_cast<int>(i)));
  }
}

}  // namespace rift::sweep
