#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "rift/report/figures/gnuplot_text.hpp"
#include "rift/statistics/descriptive.hpp"
#include "sweep_plots.hpp"

namespace rift::report {
namespace {

constexpr std::size_t kLongestLabel = 34;
constexpr int kCellHeight_px = 30;
constexpr int kCellWidth_px = 56;

struct Cells {
  DataBlock filled{"cells"}, on_dark{"on_dark"}, on_light{"on_light"};
  DataBlock missing_on_dark{"missing_on_dark"}, missing_on_light{"missing_on_light"};
  std::string holes;
  double low_m = HUGE_VAL, high_m = -HUGE_VAL;
};

void Range(const SettingGrid& grid, Cells* cells) {
  for (const auto& row : grid.cells) {
    for (const sweep::SettingResult* setting : row) {
      if (setting == nullptr || !std::isfinite(setting->mean_gap_m)) continue;
      cells->low_m = std::min(cells->low_m, setting->mean_gap_m);
      cells->high_m = std::max(cells->high_m, setting->mean_gap_m);
    }
  }
  if (!(cells->high_m > cells->low_m)) cells->high_m = cells->low_m + 1e-6;
}

void AddCell(const sweep::SweepResult& result, const sweep::SettingResult* setting, double x,
             double y, Cells* cells) {
  if (setting == nullptr || !std::isfinite(setting->mean_gap_m)) {
    cells->holes += fmt::format(
        "set object rectangle center {0},{1} size 1,1 behind fc rgb '#E6E6E6' fs solid noborder\n"
        "set label '{2}' at {0},{1} center textcolor rgb '#666666'\n",
        x, y, setting == nullptr ? "" : "no gap");
    return;
  }
  cells->filled.Add({x, y, setting->mean_gap_m});
  const double share = (setting->mean_gap_m - cells->low_m) / (cells->high_m - cells->low_m);
  const bool is_dark = share < 0.6;
  (is_dark ? cells->on_dark : cells->on_light).Add({x, y, setting->mean_gap_m});
  if (NotMeasured(result, *setting) == 0) return;
  (is_dark ? cells->missing_on_dark : cells->missing_on_light).Add({x + 0.42, y - 0.32});
}

std::string Numbers(const DataBlock& block, std::string_view colour) {
  return fmt::format(
      "{} using 1:2:(sprintf('%.3f', $3)) with labels center textcolor rgb '{}' notitle",
      block.Name(), colour);
}

std::vector<std::size_t> LettersOf(const std::vector<sweep::LevelSummary>& levels) {
  std::vector<std::size_t> letters;
  for (const auto& level : levels) {
    letters.push_back(std::min(LetterCount(level.level), kLongestLabel));
  }
  return letters;
}

/// Crosses in the cells that some trial of has no gap; the height of their entry in the legend.
int AddMissing(const Cells& cells, std::string* data, PlotCommand* plot) {
  constexpr std::string_view kCross = "with points pt 2 ps 0.5 lw 1.4 lc rgb";
  if (cells.missing_on_dark.IsEmpty() && cells.missing_on_light.IsEmpty()) return 0;
  for (const auto& [block, colour] : {std::pair{&cells.missing_on_dark, "#FFFFFF"},
                                      std::pair{&cells.missing_on_light, "#000000"}}) {
    if (block->IsEmpty()) continue;
    *data += block->Text();
    plot->Add(fmt::format("{} using 1:2 {} '{}' notitle", block->Name(), kCross, colour));
  }
  plot->Add(fmt::format("keyentry {} '#000000' title 'trials without a gap'", kCross));
  return 20;
}

std::string Tics(std::string_view axis, const std::vector<sweep::LevelSummary>& levels,
                 std::string_view rotation) {
  std::string places;
  for (std::size_t i = 0; i < levels.size(); ++i) {
    places += fmt::format("{}{} {}", i == 0 ? "" : ", ",
                          TicLabel({Shortened(levels[i].level, kLongestLabel)}), i);
  }
  return fmt::format("set {}tics {}scale 0 ({})\n", axis, rotation, places);
}

constexpr int kBins = 50;

struct Scatter {
  DataBlock pass{"pass"}, fail{"fail"}, missing{"missing"};
  double largest_m = 0.0;
};

Scatter Points(const sweep::SweepResult& result, int parameter) {
  Scatter scatter;
  for (const sweep::TrialRow& row : result.rows) {
    const double x = row.theta[parameter].number.value_or(NAN);
    if (!std::isfinite(x)) continue;
    if (!row.IsOk()) {
      scatter.missing.Add({x, 0.0});
      continue;
    }
    (row.falsified ? scatter.fail : scatter.pass).Add({x, row.comparison.gap_m});
    scatter.largest_m = std::max(scatter.largest_m, row.comparison.gap_m);
  }
  return scatter;
}

std::string PointEntries(const Scatter& scatter, double threshold_m, std::string* data) {
  PlotCommand plot;
  const auto add = [&](const DataBlock& block, const std::string& style, const std::string& title) {
    if (block.IsEmpty()) return;
    *data += block.Text();
    plot.Add(
        fmt::format("{} using 1:2 with points {} title {}", block.Name(), style, Quoted(title)));
  };
  // A trial may fail by its gap on the way, which is not what is drawn.
  add(scatter.pass, fmt::format("pt 6 ps 0.45 lc rgb '{}'", kPassColour), "holds");
  add(scatter.fail, fmt::format("pt 7 ps 0.45 lc rgb '{}'", kFailColour), "fails");
  add(scatter.missing, "pt 2 ps 0.7 lw 1.4 lc rgb '#000000'", "trials without a gap");
  plot.Add(ThresholdLine(threshold_m));
  return plot.Text();
}

// Median and range in bins: a hundred thousand dots are a blot, and a file of ten megabytes.
std::string BinnedEntries(const sweep::SweepResult& result, int parameter, std::string* data) {
  const experiment::Parameter& axis = result.parameters[parameter];
  std::vector<std::vector<double>> bins(kBins);
  for (const sweep::TrialRow& row : result.rows) {
    const double x = row.theta[parameter].number.value_or(NAN);
    if (!row.IsOk() || !std::isfinite(x)) continue;
    const double place = kBins * (x - axis.min) / (axis.max - axis.min);
    bins[std::clamp(static_cast<int>(place), 0, kBins - 1)].push_back(row.comparison.gap_m);
  }
  DataBlock block("bins");
  for (int i = 0; i < kBins; ++i) {
    if (bins[i].empty()) continue;
    block.Add({axis.min + (i + 0.5) * (axis.max - axis.min) / kBins,
               statistics::Quantile(bins[i], 0.05), statistics::Median(bins[i]),
               statistics::Quantile(bins[i], 0.95), statistics::Quantile(bins[i], 1.0)});
  }
  *data += block.Text();
  PlotCommand plot;
  plot.Add(block.Name() + " using 1:2:4 with filledcurves fc rgb '#BFD9EC' title '5 to 95 %'");
  plot.Add(fmt::format("{} using 1:3 with lines lw 2 lc rgb '{}' title 'median'", block.Name(),
                       kPassColour));
  plot.Add(fmt::format("{} using 1:5 with points pt 7 ps 0.35 lc rgb '{}' title 'largest'",
                       block.Name(), kFailColour));
  plot.Add(ThresholdLine(result.gap.threshold_m));
  return plot.Text();
}

}  // namespace

Figure HeatMapFigure(const sweep::SweepResult& result, const SettingGrid& grid,
                     const ReportOptions& options) {
  Cells cells;
  Range(grid, &cells);
  for (std::size_t i = 0; i < grid.mains.size(); ++i) {
    for (std::size_t j = 0; j < grid.others.size(); ++j) {
      AddCell(result, grid.cells[i][j], static_cast<double>(j), static_cast<double>(i), &cells);
    }
  }
  std::size_t longest = 1;
  for (const auto& level : grid.others) longest = std::max(longest, LetterCount(level.level));
  const int columns = static_cast<int>(grid.others.size());
  const int rows = static_cast<int>(grid.mains.size());
  const int width_px =
      std::clamp(190 + kCellWidth_px * columns, options.width_px, 3 * options.width_px);
  const bool numbers = (width_px - 190) / columns >= 40;
  const bool slanted = 7.0 * static_cast<double>(longest + 1) > (width_px - 190.0) / columns;
  const std::string margin =
      slanted ? SlantedMargin(LettersOf(grid.others),
                              {.first = 0.5,
                               .width_px = width_px,
                               .left_px = 45.0 + 7.0 * static_cast<double>(
                                                           std::ranges::max(LettersOf(grid.mains))),
                               .right_px = 100.0})
              : "";
  PlotCommand plot;
  // An image would have to be a whole grid of two by two cells at least, and be blurred in an SVG.
  plot.Add(cells.filled.Name() +
           " using 1:2:(0.5):(0.5):3 with boxxyerror lc palette fs solid 1 noborder notitle");
  std::string data = cells.filled.Text();
  for (const auto& [block, colour] :
       {std::pair{&cells.on_dark, "#FFFFFF"}, std::pair{&cells.on_light, "#000000"}}) {
    if (!numbers || block->IsEmpty()) continue;
    data += block->Text();
    plot.Add(Numbers(*block, colour));
  }
  const int legend_px = AddMissing(cells, &data, &plot);
  Figure figure{"fig10_gap_heat_map",
                fmt::format("Mean Sim-to-Real gap by {} and {}", grid.main_name, grid.others_name),
                width_px,
                110 + legend_px + kCellHeight_px * rows +
                    (slanted ? static_cast<int>(5 * std::min(longest, kLongestLabel)) : 0)};
  figure.plot = fmt::format(
      "{}{}{}{}set cbrange [{:.9g}:{:.9g}]\nset cblabel 'mean gap (m)' offset 2,0\n"
      "set rmargin 14\nset format cb '%.3f'\n"
      "unset grid\nset border 0\nset xlabel {}\nset ylabel {}\n{}{}"
      "set xrange [-0.5:{}]\nset yrange [{}:-0.5]\n{}",
      data, cells.holes, ViridisPalette(), margin, cells.low_m, cells.high_m,
      Quoted(grid.others_name), Quoted(grid.main_name),
      Tics("x", grid.others, slanted ? "rotate by 40 right " : ""), Tics("y", grid.mains, ""),
      columns - 0.5, rows - 0.5, plot.Text());
  return figure;
}

Figure GapOverParameterFigure(std::string name, const sweep::SweepResult& result, int parameter,
                              const ReportOptions& options) {
  const experiment::Parameter& axis = result.parameters[parameter];
  const Scatter scatter = Points(result, parameter);
  std::string data;
  const bool binned = static_cast<int>(result.rows.size()) > options.max_points;
  const std::string plot = binned ? BinnedEntries(result, parameter, &data)
                                  : PointEntries(scatter, result.gap.threshold_m, &data);
  Figure figure{std::move(name), fmt::format("Sim-to-Real gap over {}", axis.Name()),
                options.width_px, options.width_px * 2 / 3};
  const double margin = 0.02 * (axis.max - axis.min);
  figure.plot = fmt::format(
      "{}set xlabel {}\nset ylabel 'gap (m)'\nset xrange [{:.9g}:{:.9g}]\nset yrange "
      "[0:{:.9g}]\n{}",
      data, Quoted(axis.Name()), axis.min - margin, axis.max + margin,
      AxisEnd(1.03 * std::max(scatter.largest_m, result.gap.threshold_m)), plot);
  return figure;
}

}  // namespace rift::report
