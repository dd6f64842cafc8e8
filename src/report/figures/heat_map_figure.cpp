#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "rift/report/figures/gnuplot_text.hpp"
#include "sweep_plots.hpp"

namespace rift::report {
namespace {

constexpr std::size_t kLongestLabel = 28;
constexpr int kCellHeight_px = 30;
constexpr int kCellWidth_px = 56;

struct Cells {
  DataBlock filled{"cells"}, on_dark{"on_dark"}, on_light{"on_light"};
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

void AddCell(const sweep::SettingResult* setting, double x, double y, Cells* cells) {
  if (setting == nullptr || !std::isfinite(setting->mean_gap_m)) {
    cells->holes += fmt::format(
        "set object rectangle center {0},{1} size 1,1 behind fc rgb '#E6E6E6' fs solid noborder\n"
        "set label '{2}' at {0},{1} center textcolor rgb '#666666'\n",
        x, y, setting == nullptr ? "" : "no gap");
    return;
  }
  cells->filled.Add({x, y, setting->mean_gap_m});
  const double share = (setting->mean_gap_m - cells->low_m) / (cells->high_m - cells->low_m);
  (share < 0.6 ? cells->on_dark : cells->on_light).Add({x, y, setting->mean_gap_m});
}

std::string Numbers(const DataBlock& block, std::string_view colour) {
  return fmt::format(
      "{} using 1:2:(sprintf('%.3f', $3)) with labels center textcolor rgb '{}' notitle",
      block.Name(), colour);
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

}  // namespace

Figure HeatMapFigure(const SettingGrid& grid, const ReportOptions& options) {
  Cells cells;
  Range(grid, &cells);
  for (std::size_t i = 0; i < grid.mains.size(); ++i) {
    for (std::size_t j = 0; j < grid.others.size(); ++j) {
      AddCell(grid.cells[i][j], static_cast<double>(j), static_cast<double>(i), &cells);
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
  PlotCommand plot;
  // pixels: an SVG would hold a tiny bitmap otherwise, which viewers blur.
  plot.Add(cells.filled.Name() + " using 1:2:3 with image pixels notitle");
  std::string data = cells.filled.Text();
  for (const auto& [block, colour] :
       {std::pair{&cells.on_dark, "#FFFFFF"}, std::pair{&cells.on_light, "#000000"}}) {
    if (!numbers || block->IsEmpty()) continue;
    data += block->Text();
    plot.Add(Numbers(*block, colour));
  }
  Figure figure{"fig10_gap_heat_map",
                fmt::format("Mean Sim-to-Real gap by {} and {}", grid.main_name, grid.others_name),
                width_px,
                110 + kCellHeight_px * rows +
                    (slanted ? static_cast<int>(5 * std::min(longest, kLongestLabel)) : 0)};
  figure.plot = fmt::format(
      "{}{}{}set cbrange [{:.9g}:{:.9g}]\nset cblabel 'mean gap (m)' offset 2,0\n"
      "set rmargin 14\nset format cb '%.3f'\n"
      "unset grid\nset border 0\nset xlabel {}\nset ylabel {}\n{}{}"
      "set xrange [-0.5:{}]\nset yrange [{}:-0.5]\n{}",
      data, cells.holes, ViridisPalette(), cells.low_m, cells.high_m, Quoted(grid.others_name),
      Quoted(grid.main_name), Tics("x", grid.others, slanted ? "rotate by 40 right " : ""),
      Tics("y", grid.mains, ""), columns - 0.5, rows - 0.5, plot.Text());
  return figure;
}

}  // namespace rift::report
