#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "parts.hpp"
#include "rift/odometry/program_runs.hpp"
#include "rift/report/figures/setting_grid.hpp"

namespace rift::report {
namespace {

using nlohmann::json;
using odometry::CellMeasures;

std::string WordOf(const CellMeasures& cell) {
  if (cell.runs == 0) return "no run";
  return cell.DidMove() ? "" : "did not move";
}

/// One table of figure 14.
struct Measure {
  const char* title;
  std::string sentence;
  const char* legend;
  std::function<double(const CellMeasures&)> value;
};

PageChart HeatChart(const sweep::SweepResult& result,
                    const std::vector<sweep::ProgramCell>& programs, const Measure& measure) {
  const sweep::FactorSplit split = sweep::SplitFactors(result.parameters);
  json values = json::array(), columns = json::array();
  double low = HUGE_VAL, high = -HUGE_VAL;
  for (const sweep::ProgramCell& cell : programs) {
    const std::string word = WordOf(cell.measures);
    const double value = word.empty() ? measure.value(cell.measures) : NAN;
    const json tip = {
        {"setting", SettingLabel(result, cell.theta)},
        {measure.legend, !word.empty()          ? word
                         : std::isfinite(value) ? fmt::format("{:.4g}", value)
                                                : "not known"},
        {"runs that moved", fmt::format("{} of {}", cell.measures.moved, cell.measures.runs)}};
    const std::string column = sweep::CombinationLabel(cell.theta, {split.main_factor});
    if (std::find(columns.begin(), columns.end(), column) == columns.end())
      columns.push_back(column);
    const std::string line =
        split.others.empty() ? "all" : sweep::CombinationLabel(cell.theta, split.others);
    values.push_back({{"line", line},
                      {"column", column},
                      {"value", Value(value)},
                      {"word", word},
                      {"tip", tip}});
    if (!std::isfinite(value)) continue;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  PageChart chart{measure.title, measure.sentence, Template("heat.json")};
  const std::size_t lines = std::max<std::size_t>(1, programs.size() / columns.size());
  chart.spec["height"] = 46 * lines;
  SetSignal(chart.spec, "middle", low + 0.6 * (high - low));
  SetSignal(chart.spec, "x_title", result.parameters[split.main_factor].Name());
  SetSignal(chart.spec, "y_title", split.others_name);
  SetSignal(chart.spec, "legend_title", measure.legend);
  chart.spec["data"][0]["values"] = std::move(values);
  return chart;
}

PageChart SlipChart(const sweep::SweepResult& result,
                    const std::vector<sweep::ProgramCell>& programs, bool is_left) {
  json values = json::array();
  for (const sweep::ProgramCell& cell : programs) {
    if (!cell.measures.DidMove()) continue;
    const std::string name = SettingLabel(result, cell.theta);
    for (const odometry::Slip& slip : cell.measures.slip) {
      const double share = is_left ? slip.left : slip.right;
      if (!std::isfinite(share)) continue;
      values.push_back(
          {{"series", name},
           {"x", slip.u},
           {"y", 100.0 * share},
           {"tip", {{"setting", name}, {"slip", fmt::format("{:.1f} %", 100.0 * share)}}}});
    }
  }
  const char* wheel = is_left ? "left" : "right";
  PageChart chart{
      fmt::format("Slip of the {} wheel along the program", wheel),
      "1 - way over the ground / way rolled, in percent, mean of the repeats; above 0 the "
      "wheel spins, below 0 it is dragged. u is the share of what both wheels rolled.",
      Template("lines.json")};
  SetSignal(chart.spec, "x_title", "u");
  SetSignal(chart.spec, "y_title", fmt::format("slip, {} wheel (%)", wheel));
  chart.spec["data"][0]["values"] = std::move(values);
  return chart;
}

}  // namespace

std::vector<PageChart> ProgramCharts(const sweep::SweepResult& result,
                                     const std::vector<sweep::ProgramCell>& programs) {
  std::vector<PageChart> charts;
  if (programs.empty() || result.parameters.empty()) return charts;
  const std::vector<Measure> measures{
      {"Distance from the programmed path",
       "Mean distance between the camera's path and the program at equal normalised arc length, "
       "mean "
       "of the repeats, in metres (paper, figure 14, lower table).",
       "distance (m)", [](const CellMeasures& cell) { return cell.deviation_m; }},
      {"Spread of the repeats",
       "In metres (paper, figure 14, upper table); " + odometry::SpreadText() + ".", "spread (m)",
       [](const CellMeasures& cell) { return cell.spread_m; }},
      {"Drift of the odometry",
       "Distance between where encoders and camera saw the robot end, in percent of its way.",
       "drift (%)", [](const CellMeasures& cell) { return 100.0 * cell.drift_per_m; }}};
  for (const Measure& measure : measures) charts.push_back(HeatChart(result, programs, measure));
  const auto has_slip = [](const sweep::ProgramCell& cell) { return !cell.measures.slip.empty(); };
  if (std::any_of(programs.begin(), programs.end(), has_slip)) {
    charts.push_back(SlipChart(result, programs, true));
    charts.push_back(SlipChart(result, programs, false));
  }
  return charts;
}

}  // namespace rift::report
