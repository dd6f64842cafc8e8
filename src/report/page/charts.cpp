#include "parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "embedded.hpp"
#include "rift/report/figures/gnuplot_text.hpp"
#include "rift/report/figures/setting_grid.hpp"
#include "rift/sweep/falsify/result.hpp"

namespace rift::report {
nlohmann::json Template(std::string_view name) { return nlohmann::json::parse(Embedded(name)); }

void SetSignal(nlohmann::json& spec, std::string_view name, const nlohmann::json& value) {
  for (nlohmann::json& signal : spec["signals"]) {
    if (signal["name"] == name) signal["value"] = value;
  }
}

nlohmann::json Value(double value) {
  return std::isfinite(value) ? nlohmann::json(value) : nlohmann::json(nullptr);
}

namespace {

using nlohmann::json;

constexpr std::size_t kLongestLabel = 32;
constexpr int kHistogramBins = 30;
constexpr int kMostBars = 60;

void SetTable(json& spec, json values) { spec["data"][0]["values"] = std::move(values); }

std::string Metres(double value_m) {
  return std::isfinite(value_m) ? fmt::format("{:.4f} m", value_m) : "none";
}

std::string_view Colour(bool falsified) { return falsified ? kFailColour : kPassColour; }

json TrialPoint(const sweep::SweepResult& result, const sweep::TrialRow& row) {
  json tip;
  for (std::size_t i = 0; i < row.theta.size(); ++i) {
    tip[result.parameters[i].Name()] = row.theta[i].text;
  }
  tip["trial"] = row.trial;
  tip["gap"] = row.IsOk() ? Metres(row.comparison.gap_m)
                          : std::string(EnumNames(row.status)[static_cast<int>(row.status)]);
  if (row.IsOk()) tip["at u"] = fmt::format("{:.2f}", row.comparison.gap_u);
  return {{"value", Value(row.IsOk() ? row.comparison.gap_m : NAN)},
          {"falsified", row.falsified},
          {"colour", Colour(row.falsified)},
          {"tip", tip}};
}

json LevelBar(const sweep::LevelSummary& level) {
  json tip = {{"value", level.level},
              {"mean gap", Metres(level.mean_gap_m)},
              {"standard deviation", Metres(level.sd_gap_m)},
              {"above threshold", fmt::format("{} of {}", level.failures, level.told)}};
  if (level.not_ok > 0) tip["without a gap"] = std::to_string(level.not_ok);
  return {{"label", Shortened(level.level, kLongestLabel)},
          {"value", Value(level.mean_gap_m)},
          {"low", Value(level.mean_gap_m - level.sd_gap_m)},
          {"high", Value(level.mean_gap_m + level.sd_gap_m)},
          {"missing", level.not_ok},
          {"colour", kPassColour},
          {"tip", tip}};
}

PageChart Bars(std::string title, std::string sentence, const std::string& x_title, json values) {
  PageChart chart{std::move(title), std::move(sentence), Template("bars.json")};
  chart.spec["height"] = 28 * std::max<std::size_t>(values.size(), 1);
  SetSignal(chart.spec, "x_title", x_title);
  SetTable(chart.spec, std::move(values));
  return chart;
}

PageChart TrialsChart(const sweep::SweepResult& result, const ReportOptions& options) {
  auto settings = WorstSettings(result);
  const bool all = static_cast<int>(settings.size()) <= options.worst_settings;
  if (!all) settings.resize(options.worst_settings);
  // Of very many repeats every k-th: a page with a hundred thousand dots opens slowly.
  std::size_t dots = 0;
  for (const sweep::SettingResult* setting : settings) dots += setting->rows.size();
  const std::size_t step = 1 + dots / (options.table_rows + 1);
  json values = json::array();
  for (const sweep::SettingResult* setting : settings) {
    for (std::size_t i = 0; i < setting->rows.size(); i += step) {
      json point = TrialPoint(result, result.rows[setting->rows[i]]);
      point["label"] = Shortened(SettingLabel(result, setting->theta), kLongestLabel);
      values.push_back(std::move(point));
    }
  }
  PageChart chart{
      "Gap of every trial",
      fmt::format(
          "One dot a trial, in metres, {}{}; diamonds are above the threshold "
          "(dashed), crosses have no gap.",
          all ? "the worst setting first"
              : fmt::format("the {} worst of {} settings", settings.size(), result.settings.size()),
          step == 1 ? "" : fmt::format(", {} of {} trials evenly picked", values.size(), dots)),
      Template("dots.json")};
  chart.spec["height"] = 19 * settings.size() + 10;
  SetSignal(chart.spec, "threshold", result.gap.threshold_m);
  SetSignal(chart.spec, "x_title", "gap (m)");
  SetTable(chart.spec, std::move(values));
  return chart;
}

PageChart HeatChart(const SettingGrid& grid) {
  json values = json::array();
  double low_m = HUGE_VAL, high_m = -HUGE_VAL;
  for (std::size_t i = 0; i < grid.mains.size(); ++i) {
    for (std::size_t j = 0; j < grid.others.size(); ++j) {
      const sweep::SettingResult* setting = grid.cells[i][j];
      if (setting == nullptr) continue;
      const json tip = {{grid.main_name, grid.mains[i].level},
                        {grid.others_name, grid.others[j].level},
                        {"mean gap", Metres(setting->mean_gap_m)},
                        {"above threshold", fmt::format("{} of {}", setting->verdict.above,
                                                        setting->verdict.repeats)}};
      values.push_back({{"line", Shortened(grid.mains[i].level, kLongestLabel)},
                        {"column", Shortened(grid.others[j].level, kLongestLabel)},
                        {"value", Value(setting->mean_gap_m)},
                        {"tip", tip}});
      if (!std::isfinite(setting->mean_gap_m)) continue;
      low_m = std::min(low_m, setting->mean_gap_m);
      high_m = std::max(high_m, setting->mean_gap_m);
    }
  }
  PageChart chart{fmt::format("Mean gap by {} and {}", grid.main_name, grid.others_name),
                  "Mean over the trials of each setting, in metres; lighter is worse.",
                  Template("heat.json")};
  chart.spec["height"] = 34 * grid.mains.size();
  SetSignal(chart.spec, "middle", low_m + 0.6 * (high_m - low_m));
  SetSignal(chart.spec, "x_title", grid.others_name);
  SetSignal(chart.spec, "y_title", grid.main_name);
  SetTable(chart.spec, std::move(values));
  return chart;
}

PageChart LevelsChart(const sweep::SweepResult& result, int parameter) {
  const std::string name = result.parameters[parameter].Name();
  json values = json::array();
  for (const sweep::LevelSummary& level : sweep::SummariseBy(result, {parameter})) {
    values.push_back(LevelBar(level));
  }
  PageChart chart =
      Bars("Mean gap by " + name, "Mean gap in metres, with the standard deviation of the trials.",
           "gap (m)", std::move(values));
  SetSignal(chart.spec, "threshold", result.gap.threshold_m);
  return chart;
}

PageChart FailuresChart(const sweep::SweepResult& result, const std::string& name,
                        const std::vector<sweep::LevelSummary>& levels) {
  json values = json::array();
  for (const sweep::LevelSummary& level : levels) {
    json bar = LevelBar(level);
    bar["value"] = level.failures;
    bar["low"] = bar["high"] = nullptr;
    bar["colour"] = kFailColour;
    values.push_back(std::move(bar));
  }
  const std::string threshold = Number(result.gap.threshold_m);
  return Bars("Failures by " + name,
              fmt::format("Number of trials whose gap exceeds {} m; crosses mark values with "
                          "trials without a gap.",
                          threshold),
              fmt::format("trials with gap > {} m", threshold), std::move(values));
}

// Crossing zero never happens, but a bin that holds the threshold is split at it, so that a
// colour is never half wrong.
PageChart HistogramChart(const sweep::SweepResult& result) {
  const double threshold_m = result.gap.threshold_m;
  double largest_m = threshold_m;
  for (const sweep::TrialRow& row : result.rows) {
    if (row.IsOk()) largest_m = std::max(largest_m, row.comparison.gap_m);
  }
  // Bins are a whole fraction of the threshold where there is one.
  double width_m = AxisEnd(largest_m) / kHistogramBins;
  if (threshold_m > 0.0) width_m = threshold_m / std::max(1.0, std::round(threshold_m / width_m));
  std::vector<long> counts(static_cast<std::size_t>(largest_m / width_m) + 2, 0);
  for (const sweep::TrialRow& row : result.rows) {
    if (!row.IsOk()) continue;
    // A bin holds (from, to]: a gap equal to the threshold does not falsify.
    const double place = std::ceil(row.comparison.gap_m / width_m - 1e-12) - 1.0;
    auto bin = static_cast<std::size_t>(std::max(0.0, place));
    ++counts[std::min(bin, counts.size() - 1)];
  }
  json values = json::array();
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const double from_m = static_cast<double>(i) * width_m, to_m = from_m + width_m;
    if (counts[i] == 0) continue;
    values.push_back({{"from", from_m},
                      {"to", to_m},
                      {"count", counts[i]},
                      {"colour", Colour(from_m > threshold_m - 0.5 * width_m)},
                      {"tip",
                       {{"gap", fmt::format("{:.4f} to {:.4f} m", from_m, to_m)},
                        {"trials", std::to_string(counts[i])}}}});
  }
  PageChart chart{"How large the gaps are",
                  "Number of trials by gap in metres; orange is above the threshold.",
                  Template("histogram.json")};
  SetSignal(chart.spec, "threshold", threshold_m);
  SetSignal(chart.spec, "x_title", "gap (m)");
  SetTable(chart.spec, std::move(values));
  return chart;
}

PageChart ScatterChart(const sweep::SweepResult& result, int parameter,
                       const ReportOptions& options) {
  const std::string name = result.parameters[parameter].Name();
  std::vector<const sweep::TrialRow*> rows;
  for (const sweep::TrialRow& row : result.rows) {
    if (row.IsOk() && row.theta[parameter].number) rows.push_back(&row);
  }
  const std::size_t measured = rows.size();
  // Every k-th trial: a page with a hundred thousand dots opens slowly and shows a blot.
  const std::size_t step = 1 + measured / (options.table_rows + 1);
  json values = json::array();
  for (std::size_t i = 0; i < measured; i += step) {
    json point = TrialPoint(result, *rows[i]);
    point["x"] = *rows[i]->theta[parameter].number;
    values.push_back(std::move(point));
  }
  PageChart chart{
      "Gap over " + name,
      fmt::format("One dot a trial, in metres, {}; diamonds are above the threshold.",
                  step == 1 ? std::string("all of them")
                            : fmt::format("{} of {} evenly picked", values.size(), measured)),
      Template("scatter.json")};
  SetSignal(chart.spec, "threshold", result.gap.threshold_m);
  SetSignal(chart.spec, "x_title", name);
  SetTable(chart.spec, std::move(values));
  return chart;
}

void AddGridCharts(const sweep::SweepResult& result, const ReportOptions& options,
                   std::vector<PageChart>* charts) {
  const SettingGrid grid = LayOut(result);
  const bool fits = !grid.cells.empty() && grid.CellCount() <= options.max_cells;
  if (fits && !grid.others_name.empty() && grid.others.size() <= kMostBars) {
    charts->push_back(HeatChart(grid));
  }
  const experiment::Parameter& main =
      result.parameters[sweep::SplitFactors(result.parameters).main_factor];
  if (!main.IsContinuous() && grid.mains.size() <= kMostBars) {
    charts->push_back(FailuresChart(result, grid.main_name, grid.mains));
  }
  if (!grid.cells.empty() && !grid.others_name.empty() && grid.others.size() <= kMostBars) {
    charts->push_back(FailuresChart(result, grid.others_name, grid.others));
  }
}

}  // namespace

std::vector<PageChart> PageCharts(const sweep::SweepResult& result, const ReportOptions& options) {
  std::vector<PageChart> charts;
  if (result.all.n == 0) return charts;
  charts.push_back(TrialsChart(result, options));
  charts.push_back(HistogramChart(result));
  if (result.parameters.empty()) return charts;
  AddGridCharts(result, options, &charts);
  for (int i = 0; i < static_cast<int>(result.parameters.size()); ++i) {
    const experiment::Parameter& parameter = result.parameters[i];
    if (parameter.IsContinuous()) {
      charts.push_back(ScatterChart(result, i, options));
    } else if (parameter.levels.size() > 1 && parameter.levels.size() <= kMostBars) {
      charts.push_back(LevelsChart(result, i));
    }
  }
  return charts;
}

}  // namespace rift::report
