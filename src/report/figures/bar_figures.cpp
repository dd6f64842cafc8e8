#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "rift/report/figures/gnuplot_text.hpp"
#include "sweep_plots.hpp"

namespace rift::report {
namespace {

constexpr std::size_t kLongestLabel = 34;
constexpr std::size_t kMostSlanted = 20;  // more labels stand upright, and say the level alone
constexpr double kGroupWidth = 0.84;      // of the distance between two groups

struct TicLabels {
  std::string command;
  bool rotated = false;
};

// Labels of categories at 0, 1, 2, ...: upright when they fit beside each other, else slanted.
TicLabels Categories(const std::vector<std::vector<std::string>>& labels, int width_px) {
  std::size_t longest = 1;
  for (const auto& lines : labels) {
    for (const std::string& line : lines) longest = std::max(longest, LetterCount(line));
  }
  const double letter_px = 7.0;
  TicLabels tics;
  tics.rotated = letter_px * static_cast<double>((longest + 1) * labels.size()) > width_px - 70;
  std::string places;
  std::vector<std::size_t> letters;
  for (std::size_t i = 0; i < labels.size(); ++i) {
    std::vector<std::string> lines = labels[i];
    if (labels.size() > kMostSlanted) {
      lines.resize(1);
    } else if (tics.rotated && lines.size() > 1) {
      lines = {fmt::format("{}", fmt::join(lines, ", "))};
    }
    letters.push_back(LetterCount(lines.front()));
    places += fmt::format("{}{} {}", i == 0 ? "" : ", ", TicLabel(lines), i);
  }
  const char* rotation = !tics.rotated                  ? ""
                         : labels.size() > kMostSlanted ? "rotate by 90 right "
                                                        : "rotate by 40 right ";
  tics.command = fmt::format("set xtics {}({})\n", rotation, places);
  if (tics.rotated && labels.size() <= kMostSlanted) {
    tics.command += SlantedMargin(
        letters, {.first = 0.6, .width_px = width_px, .left_px = 55.0, .right_px = 15.0});
  }
  return tics;
}

std::string LevelName(const sweep::LevelSummary& level) {
  return Shortened(level.level, kLongestLabel);
}

// Room below the axis for slanted or upright labels.
int LabelRoom_px(const TicLabels& tics, const std::vector<sweep::LevelSummary>& levels) {
  if (!tics.rotated) return 0;
  std::size_t longest = 0;
  for (const auto& level : levels) longest = std::max(longest, LetterCount(LevelName(level)));
  const bool upright = levels.size() > kMostSlanted;
  return static_cast<int>((upright ? 6.5 : 4.2) * static_cast<double>(longest + (upright ? 0 : 6)));
}

int BarChartWidth_px(std::size_t bars, const ReportOptions& options) {
  return std::clamp(static_cast<int>(90 + 16 * bars), options.width_px, 2 * options.width_px);
}

void AddTrials(const sweep::SweepResult& result, const sweep::SettingResult& setting, double x,
               DataBlock* trials, DataBlock* missing, double* largest_m) {
  for (const double gap_m : GapsOf(result, setting)) {
    trials->Add({x, gap_m});
    *largest_m = std::max(*largest_m, gap_m);
  }
  if (NotMeasured(result, setting) > 0) missing->Add({x});
}

std::string SeriesEntry(const DataBlock& bars, int index, int count, std::string_view title) {
  const std::string style =
      fmt::format("with boxes lc rgb '{}' title {}", SeriesColour(index, count), Quoted(title));
  // A series of missing trials only keeps its place in the legend.
  if (bars.IsEmpty()) return "keyentry " + style;
  return fmt::format("{} using 1:2:3 {}", bars.Name(), style);
}

// A cross a little above the axis, where it cannot be overlooked.
std::string MissingEntry(const DataBlock& missing, double axis_end) {
  return fmt::format(
      "{} using 1:(0.03 * {:.9g}) with points pt 2 ps 0.8 lw 1.6 lc rgb '#000000' "
      "title 'trials without a gap'",
      missing.Name(), axis_end);
}

}  // namespace

Figure GapBySettingFigure(const sweep::SweepResult& result, const SettingGrid& grid,
                          const ReportOptions& options) {
  const int series = static_cast<int>(grid.others.size());
  const double bar_width = kGroupWidth / series;
  DataBlock trials("trials"), missing("missing");
  double largest_m = result.gap.threshold_m;
  std::string data;
  PlotCommand plot;
  for (int j = 0; j < series; ++j) {
    DataBlock bars(fmt::format("bars_{}", j));
    for (std::size_t i = 0; i < grid.mains.size(); ++i) {
      const sweep::SettingResult* setting = grid.cells[i][j];
      if (setting == nullptr) continue;
      const double x = static_cast<double>(i) + (j - 0.5 * (series - 1)) * bar_width;
      if (std::isfinite(setting->mean_gap_m)) bars.Add({x, setting->mean_gap_m, 0.92 * bar_width});
      AddTrials(result, *setting, x, &trials, &missing, &largest_m);
    }
    if (!bars.IsEmpty()) data += bars.Text();
    plot.Add(SeriesEntry(bars, j, series, Shortened(grid.others[j].level, kLongestLabel)));
  }
  data += trials.Text();
  const double end_m = AxisEnd(1.03 * largest_m);
  plot.Add(ThresholdLine(result.gap.threshold_m));
  plot.Add(trials.Name() +
           " using 1:2 with points pt 7 ps 0.35 lc rgb '#000000' title 'single trial'");
  if (!missing.IsEmpty()) {
    data += missing.Text();
    plot.Add(MissingEntry(missing, end_m));
  }
  std::vector<std::vector<std::string>> labels;
  for (const auto& level : grid.mains) labels.push_back({LevelName(level)});
  const int width_px = BarChartWidth_px(static_cast<std::size_t>(grid.CellCount()), options);
  const TicLabels tics = Categories(labels, width_px);
  Figure figure{"fig07_gap_by_setting",
                fmt::format("Sim-to-Real gap by {} and {}", grid.main_name, grid.others_name),
                width_px, options.width_px * 3 / 4 + LabelRoom_px(tics, grid.mains)};
  figure.plot = fmt::format(
      "{}{}set grid noxtics ytics\nset key title {} noenhanced\nset xlabel {}\n"
      "set ylabel 'mean gap (m)'\nset xrange [-0.6:{:.9g}]\nset yrange [0:{:.9g}]\n{}",
      data, tics.command, Quoted(grid.others_name), Quoted(grid.main_name),
      static_cast<double>(grid.mains.size()) - 0.4, end_m, plot.Text());
  return figure;
}

Figure MeanByLevelFigure(std::string name, const std::string& factor,
                         const std::vector<sweep::LevelSummary>& levels, double threshold_m,
                         const ReportOptions& options) {
  DataBlock bars("bars"), whiskers("whiskers"), missing("missing");
  std::vector<std::vector<std::string>> labels;
  double largest_m = threshold_m;
  for (std::size_t i = 0; i < levels.size(); ++i) {
    const double x = static_cast<double>(i);
    labels.push_back({LevelName(levels[i]), fmt::format("n = {}", levels[i].n)});
    if (levels[i].not_ok > 0) missing.Add({x});
    if (!std::isfinite(levels[i].mean_gap_m)) continue;
    bars.Add({x, levels[i].mean_gap_m, 0.7});
    const double sd_m = std::isfinite(levels[i].sd_gap_m) ? levels[i].sd_gap_m : 0.0;
    if (sd_m > 0.0) whiskers.Add({x, levels[i].mean_gap_m, sd_m});
    largest_m = std::max(largest_m, levels[i].mean_gap_m + sd_m);
  }
  PlotCommand plot;
  plot.Add(fmt::format("{} using 1:2:3 with boxes lc rgb '{}' title 'mean gap'", bars.Name(),
                       kPassColour));
  plot.Add(ThresholdLine(threshold_m));
  std::string data = bars.Text();
  if (!whiskers.IsEmpty()) {
    data += whiskers.Text();
    plot.Add(whiskers.Name() +
             " using 1:($2 - $3):(0):(2 * $3) with vectors heads size screen 0.008,90 lw 1.4 lc "
             "rgb '#222222' "
             "title 'standard deviation'");
  }
  const double end_m = AxisEnd(1.03 * largest_m);
  if (!missing.IsEmpty()) {
    data += missing.Text();
    plot.Add(MissingEntry(missing, end_m));
  }
  // The numbers stand near the foot of the bars, where no whisker crosses them.
  if (levels.size() <= 12) {
    plot.Add(
        fmt::format("{} using 1:({:.9g}):(sprintf('%.3f', $2)) with labels center "
                    "textcolor rgb '#FFFFFF' notitle",
                    bars.Name(), 0.09 * end_m));
  }
  const int width_px = BarChartWidth_px(levels.size(), options);
  const TicLabels tics = Categories(labels, width_px);
  Figure figure{std::move(name), fmt::format("Mean Sim-to-Real gap by {}", factor), width_px,
                options.width_px * 2 / 3 + LabelRoom_px(tics, levels)};
  figure.plot = fmt::format(
      "{}{}set grid noxtics ytics\nset xlabel {} offset 0,-0.8\nset ylabel 'gap (m)'\nset xrange "
      "[-0.6:{:.9g}]\n"
      "set yrange [0:{:.9g}]\n{}",
      data, tics.command, Quoted(factor), static_cast<double>(levels.size()) - 0.4, end_m,
      plot.Text());
  return figure;
}

Figure FailuresByLevelFigure(std::string name, const std::string& factor,
                             const std::vector<sweep::LevelSummary>& levels,
                             const ReportOptions& options) {
  DataBlock bars("bars"), missing("missing");
  std::vector<std::vector<std::string>> labels;
  std::string counts;
  int most = 1;
  for (std::size_t i = 0; i < levels.size(); ++i) {
    const sweep::LevelSummary& level = levels[i];
    labels.push_back({LevelName(level), fmt::format("of {}", level.told)});
    if (level.not_ok > 0) missing.Add({static_cast<double>(i)});
    bars.Add({static_cast<double>(i), static_cast<double>(level.failures), 0.7});
    if (levels.size() <= 40) {
      counts += fmt::format("set label '{}' at {},{} center offset 0,0.6\n", level.failures, i,
                            level.failures);
    }
    most = std::max(most, level.failures);
  }
  PlotCommand plot;
  plot.Add(fmt::format("{} using 1:2:3 with boxes lc rgb '{}' notitle", bars.Name(), kFailColour));
  std::string data = bars.Text();
  if (!missing.IsEmpty()) {
    data += missing.Text();
    plot.Add(MissingEntry(missing, 1.15 * most));
  }
  const int width_px = BarChartWidth_px(levels.size(), options);
  const TicLabels tics = Categories(labels, width_px);
  Figure figure{std::move(name), fmt::format("Trials that fail by {}", factor), width_px,
                options.width_px * 3 / 5 + LabelRoom_px(tics, levels)};
  figure.plot = fmt::format(
      "{}{}{}set grid noxtics ytics\nset xlabel {} offset 0,-0.8\nset ylabel 'trials that "
      "fail'\nset xrange "
      "[-0.6:{:.9g}]\n"
      "set yrange [0:{:.9g}]\nset ytics {}\n{}",
      data, tics.command, counts, Quoted(factor), static_cast<double>(levels.size()) - 0.4,
      1.15 * most, std::max(1, (most + 4) / 5), plot.Text());
  return figure;
}

}  // namespace rift::report
