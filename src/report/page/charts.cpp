#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "embedded.hpp"
#include "parts.hpp"
#include "rift/experiment/words.hpp"
#include "rift/report/figures/gnuplot_text.hpp"
#include "rift/report/text/trial_query.hpp"
#include "rift/statistics/sample.hpp"

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

constexpr int kHistogramBins = 30;
constexpr double kMostBins = 1000;  ///< the last one of them holds all larger gaps
constexpr std::size_t kMostDots = 1500;

/// Bins of one width from 0; where there is a threshold it is the edge of two, so that no colour is
/// half wrong. A bin holds (from, to]: a gap equal to the threshold does not falsify.
class Bins {
 public:
  explicit Bins(const sweep::SweepResult& result) {
    const double threshold_m = result.gap.threshold_m;
    double largest_m = threshold_m;
    for (const sweep::TrialRow& row : result.rows) {
      if (row.IsOk()) largest_m = std::max(largest_m, row.comparison.gap_m);
    }
    width_m_ = AxisEnd(largest_m) / kHistogramBins;
    if (threshold_m > 0.0)
      width_m_ = threshold_m / std::max(1.0, std::round(threshold_m / width_m_));
    const double wanted = std::floor(largest_m / width_m_) + 2.0;
    count_ = static_cast<std::size_t>(std::min(wanted, kMostBins));
    is_cut_ = wanted > kMostBins;
  }

  std::vector<long> Count(const sweep::SweepResult& result) const {
    std::vector<long> counts(count_, 0);
    for (const sweep::TrialRow& row : result.rows) {
      if (!row.IsOk()) continue;
      const double place = std::ceil(row.comparison.gap_m / width_m_ - 1e-12) - 1.0;
      ++counts[static_cast<std::size_t>(std::clamp(place, 0.0, static_cast<double>(count_ - 1)))];
    }
    return counts;
  }
  double From_m(std::size_t bin) const { return static_cast<double>(bin) * width_m_; }
  double Width_m() const { return width_m_; }
  std::string Text(std::size_t bin) const {
    if (is_cut_ && bin + 1 == count_) return fmt::format("above {:.4f} m", From_m(bin));
    return fmt::format("{:.4f} to {:.4f} m", From_m(bin), From_m(bin + 1));
  }
  /// Of the last bin where it holds more than its width.
  std::string Note() const {
    if (!is_cut_) return "";
    return fmt::format(" The last bar is of all gaps above {} m.", Number(From_m(count_ - 1)));
  }

 private:
  double width_m_ = 0.0;
  std::size_t count_ = 0;
  bool is_cut_ = false;
};

}  // namespace

PageChart GapHistogram(const sweep::SweepResult& result, const std::vector<PageView>& views) {
  const Bins bins(result);
  const double threshold_m = result.gap.threshold_m;
  const std::vector<long> counts = bins.Count(result);
  json values = json::array();
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const double from_m = bins.From_m(i), to_m = bins.From_m(i + 1);
    const bool is_above = from_m > threshold_m - 0.5 * bins.Width_m();
    values.push_back({{"from", from_m},
                      {"to", to_m},
                      {"count", counts[i]},
                      {"colour", is_above ? kFailColour : kPassColour},
                      {"tip", {{"gap", bins.Text(i)}}}});
  }
  PageChart chart{
      "How large the gaps are",
      "Number of trials by gap in metres; orange is above the threshold (dashed)." + bins.Note(),
      Template("histogram.json")};
  SetSignal(chart.spec, "threshold", threshold_m);
  SetSignal(chart.spec, "x_title", "gap (m)");
  chart.spec["data"][0]["values"] = std::move(values);
  chart.fields = {"count"};
  for (const PageView& view : views) {
    json entries = json::array();
    for (const long count : bins.Count(*view.part)) entries.push_back({count});
    chart.views.push_back(std::move(entries));
  }
  return chart;
}

namespace {

json CellValues(const sweep::FailingRegion& region) {
  json entries = json::array();
  for (const sweep::RegionCell& cell : region.cells) {
    entries.push_back({Value(std::round(1000.0 * cell.share) / 10.0), cell.trials});
  }
  return entries;
}

/// One parameter with a list of values has no plane: a line of cells.
sweep::FailingRegion OneLine(const sweep::SweepResult& result) {
  sweep::FailingRegion region;
  region.x_parameter = 0;
  const experiment::Parameter& axis = result.parameters.front();
  const std::vector<sweep::LevelSummary> levels = sweep::SummariseBy(result, {0});
  for (const experiment::ParameterValue& value : axis.levels) {
    sweep::RegionCell cell{.x = value.text};
    for (const sweep::LevelSummary& level : levels) {
      if (level.level != value.text || level.told == 0) continue;
      cell.trials = level.told;
      cell.share = static_cast<double>(level.failures) / level.told;
    }
    region.cells.push_back(std::move(cell));
  }
  return region;
}

std::string NameOf(const sweep::SweepResult& result, int parameter) {
  return result.parameters[parameter].Name();
}

PageChart HeatMap(const sweep::SweepResult& result, const sweep::FailingRegion& region) {
  const bool is_line = region.y_parameter < 0;
  const std::string x = NameOf(result, region.x_parameter);
  const std::string y = is_line ? "" : NameOf(result, region.y_parameter);
  std::vector<std::string> columns, lines;
  for (const sweep::RegionCell& cell : region.cells) {
    columns.push_back(cell.x);
    lines.push_back(cell.y);
  }
  columns = ShortenedApart(columns, kMostLabelLetters);
  lines = ShortenedApart(lines, kMostLabelLetters);
  json values = json::array();
  for (std::size_t i = 0; i < region.cells.size(); ++i) {
    const sweep::RegionCell& cell = region.cells[i];
    json tip = {{experiment::LabelOf(x), cell.x}};
    std::string query = TrialsWhere(x, cell.x);
    if (!is_line) {
      tip[experiment::LabelOf(y)] = cell.y;
      query = Both(query, TrialsWhere(y, cell.y));
    }
    values.push_back({{"line", lines[i]},
                      {"column", columns[i]},
                      {"value", Value(std::round(1000.0 * cell.share) / 10.0)},
                      {"trials", cell.trials},
                      {"query", region.is_smoothed ? "" : query},
                      {"tip", tip}});
  }
  PageChart chart{"", "", Template("heat.json")};
  const std::size_t line_count =
      is_line ? 1 : std::max<std::size_t>(1, result.parameters[region.y_parameter].levels.size());
  chart.spec["height"] = std::clamp<std::size_t>(64 * line_count, 80, 240);
  if (!is_line && result.parameters[region.y_parameter].IsContinuous()) chart.spec["height"] = 230;
  SetSignal(chart.spec, "middle", 60.0);
  const std::size_t column_count = result.parameters[region.x_parameter].levels.size();
  if (column_count > 0 && column_count <= 6) {
    chart.spec["axes"][0].update({{"labelAngle", 0}, {"labelAlign", "center"}});
  }
  SetSignal(chart.spec, "digits", ".0f");
  SetSignal(chart.spec, "scheme", "oranges");
  SetSignal(chart.spec, "low_is_dark", false);
  SetSignal(chart.spec, "range", {0, 100});
  SetSignal(chart.spec, "legend_title", "runs that fail (%)");
  SetSignal(chart.spec, "x_title", experiment::LabelOf(x));
  SetSignal(chart.spec, "y_title", experiment::LabelOf(y));
  chart.spec["data"][0]["values"] = std::move(values);
  return chart;
}

json TrialDots(const sweep::SweepResult& result, const sweep::FailingRegion& region) {
  json dots = json::array();
  for (const std::size_t i : statistics::SampleInOrder(result.rows.size(), kMostDots)) {
    const sweep::TrialRow& row = result.rows[i];
    if (!row.Tells()) continue;
    const std::string number = std::to_string(i + 1);
    dots.push_back(
        {{"x", *row.theta[region.x_parameter].number},
         {"y", *row.theta[region.y_parameter].number},
         {"row", i + 1},
         {"falsified", row.falsified},
         {"query", TrialsNumbered({static_cast<int>(i)})},
         {"tip",
          {{"row", number},
           {"gap", row.IsOk() ? fmt::format("{:.4f} m", row.comparison.gap_m) : "none"}}}});
  }
  return dots;
}

PageChart Plane(const sweep::SweepResult& result, const sweep::FailingRegion& region) {
  json patches = json::array();
  for (const sweep::RegionCell& cell : region.cells) {
    patches.push_back({{"x", cell.x_low},
                       {"x2", cell.x_high},
                       {"y", cell.y_low},
                       {"y2", cell.y_high},
                       {"value", Value(100.0 * cell.share)}});
  }
  PageChart chart{"", "", Template("region.json")};
  chart.spec["height"] = 230;
  SetSignal(chart.spec, "x_title", experiment::LabelOf(NameOf(result, region.x_parameter)));
  SetSignal(chart.spec, "y_title", experiment::LabelOf(NameOf(result, region.y_parameter)));
  const int sides[] = {region.x_parameter, region.y_parameter};
  for (std::size_t side = 0; side < 2; ++side) {
    if (result.parameters[sides[side]].is_logarithmic) chart.spec["scales"][side]["type"] = "log";
  }
  chart.spec["data"][0]["values"] = std::move(patches);
  chart.spec["data"][1]["values"] = TrialDots(result, region);
  return chart;
}

}  // namespace

PageChart FailureMap(const sweep::SweepResult& result, const sweep::FailingRegion& whole,
                     const std::vector<PageView>& views) {
  sweep::FailingRegion region = whole;
  const bool is_line = region.x_parameter < 0 && result.parameters.size() == 1 &&
                       !result.parameters.front().IsContinuous();
  if (is_line) region = OneLine(result);
  if (region.cells.empty() || region.cells.size() > sweep::kMostRegionCells) return {};
  const auto is_range = [&](int parameter) {
    return parameter >= 0 && result.parameters[parameter].IsContinuous();
  };
  PageChart chart = is_range(region.x_parameter) && is_range(region.y_parameter)
                        ? Plane(result, region)
                        : HeatMap(result, region);
  chart.title = fmt::format("Where it fails, by {}", NameOf(result, region.x_parameter));
  if (!is_line) chart.title += " and " + NameOf(result, region.y_parameter);
  chart.sentence =
      region.is_smoothed
          ? fmt::format(
                "Share of failing runs in per cent, {} nearest to each patch, the other "
                "parameters being what {} had.",
                region.nearest == 1 ? "of the setting"
                                    : fmt::format("the mean of the {} settings", region.nearest),
                region.nearest == 1 ? "that setting" : "those settings")
          : "Share of runs that fail in per cent, over all values of the other parameters; crosses "
            "were not tried.";
  chart.fields = {"value", "trials"};
  for (const PageView& view : views) {
    chart.views.push_back(CellValues(
        is_line ? OneLine(*view.part)
                : sweep::MapFailures(*view.part, {region.x_parameter, region.y_parameter})));
  }
  return chart;
}

}  // namespace rift::report
