#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "rift/report/figures/gnuplot_text.hpp"
#include "rift/sweep/falsify/result.hpp"
#include "sweep_plots.hpp"

namespace rift::report {
namespace {

constexpr std::size_t kLongestLabel = 44;
constexpr int kRow_px = 17;
constexpr int kMostTrialColours = 8;

// Grouped by the main factor when all fit; otherwise the worst. Of many settings those without any
// gap are left out: rows of nothing but crosses show nothing.
std::vector<const sweep::SettingResult*> SettingsToDraw(const sweep::SweepResult& result,
                                                        int limit) {
  if (static_cast<int>(result.settings.size()) > limit) {
    auto settings = WorstSettings(result);
    std::erase_if(settings,
                  [](const auto* setting) { return !std::isfinite(setting->mean_gap_m); });
    if (static_cast<int>(settings.size()) > limit) settings.resize(limit);
    return settings;
  }
  const int main_factor = sweep::SplitFactors(result.parameters).main_factor;
  std::vector<std::string> mains;
  std::vector<std::pair<std::size_t, const sweep::SettingResult*>> placed;
  for (const sweep::SettingResult& setting : result.settings) {
    const std::string& main = setting.theta[main_factor].text;
    const auto found = std::find(mains.begin(), mains.end(), main);
    placed.emplace_back(found - mains.begin(), &setting);
    if (found == mains.end()) mains.push_back(main);
  }
  std::stable_sort(placed.begin(), placed.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<const sweep::SettingResult*> settings;
  for (const auto& [place, setting] : placed) settings.push_back(setting);
  return settings;
}

std::size_t CountWithGap(const sweep::SweepResult& result) {
  return static_cast<std::size_t>(
      std::count_if(result.settings.begin(), result.settings.end(),
                    [](const auto& setting) { return std::isfinite(setting.mean_gap_m); }));
}

std::vector<std::string> TrialNames(const sweep::SweepResult& result,
                                    const std::vector<const sweep::SettingResult*>& settings) {
  std::vector<std::string> names;
  for (const sweep::SettingResult* setting : settings) {
    for (const int row : setting->rows) {
      const std::string& name = result.rows[row].trial;
      if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
    }
  }
  std::stable_sort(names.begin(), names.end(), [](const std::string& a, const std::string& b) {
    return std::pair(a.size(), a) < std::pair(b.size(), b);  // "2" before "10"
  });
  return names;
}

struct TrialDots {
  std::map<std::string, DataBlock> by_trial;
  DataBlock missing{"missing"};
  DataBlock ranges{"ranges"};
  double largest_m = 0.0;

  void Add(const sweep::SweepResult& result, const sweep::SettingResult& setting, double y,
           const std::vector<std::string>& names) {
    double low_m = HUGE_VAL, high_m = -HUGE_VAL;
    for (const int index : setting.rows) {
      const sweep::TrialRow& row = result.rows[index];
      if (!row.IsOk()) {
        missing.Add({0.0, y});
        continue;
      }
      const auto place = std::find(names.begin(), names.end(), row.trial) - names.begin();
      const double gap_m = row.comparison.gap_m;
      by_trial.try_emplace(row.trial, fmt::format("trial_{}", place)).first->second.Add({gap_m, y});
      low_m = std::min(low_m, gap_m);
      high_m = std::max(high_m, gap_m);
    }
    if (high_m > low_m) ranges.Add({low_m, y, high_m - low_m, 0.0});
    largest_m = std::max(largest_m, high_m);
  }
};

std::string TrialEntries(const TrialDots& dots, const std::vector<std::string>& names,
                         double threshold_m, std::string* data) {
  PlotCommand plot;
  if (!dots.ranges.IsEmpty()) {
    *data += dots.ranges.Text();
    plot.Add(dots.ranges.Name() +
             " using 1:2:3:4 with vectors nohead lw 1 lc rgb '#BBBBBB' notitle");
  }
  const bool coloured = static_cast<int>(names.size()) <= kMostTrialColours;
  const std::vector<int> shapes = {7, 5, 9, 11, 13, 6, 4, 8};
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto found = dots.by_trial.find(names[i]);
    if (found == dots.by_trial.end()) continue;
    *data += found->second.Text();
    const std::string title =
        coloured ? "title " + Quoted("trial " + Shortened(names[i], 20)) : "notitle";
    plot.Add(fmt::format(
        "{} using 1:2 with points pt {} ps 0.6 lc rgb '{}' {}", found->second.Name(),
        coloured ? shapes[i] : 7,
        coloured ? SeriesColour(static_cast<int>(i), kMostTrialColours) : std::string(kPassColour),
        title));
  }
  if (!dots.missing.IsEmpty()) {
    *data += dots.missing.Text();
    plot.Add(dots.missing.Name() +
             " using 1:2 with points pt 2 ps 0.8 lw 1.6 lc rgb '#D55E00' "
             "title 'trials without a gap'");
  }
  plot.Add("keyentry with lines lw 1.2 dt 2 lc rgb '#000000' title " +
           Quoted(fmt::format("threshold {} m", Number(threshold_m))));
  return plot.Text();
}

}  // namespace

Figure GapByTrialFigure(const sweep::SweepResult& result, const ReportOptions& options) {
  const auto settings = SettingsToDraw(result, options.worst_settings);
  const std::vector<std::string> names = TrialNames(result, settings);
  TrialDots dots;
  std::string tics;
  std::size_t longest = 0;
  for (std::size_t i = 0; i < settings.size(); ++i) {
    const double y = static_cast<double>(i);
    dots.Add(result, *settings[i], y, names);
    const std::string label = Shortened(SettingLabel(result, settings[i]->theta), kLongestLabel);
    longest = std::max(longest, LetterCount(label));
    tics += fmt::format("{}{} {}", i == 0 ? "" : ", ", TicLabel({label}), i);
  }
  std::string data;
  const double threshold_m = result.gap.threshold_m;
  const std::string plot = TrialEntries(dots, names, threshold_m, &data);
  const int count = static_cast<int>(settings.size());
  // Long labels take room of their own, not the plot's.
  constexpr std::size_t kFitting = 16, kLetter_px = 6;
  const int labels_px = static_cast<int>(kLetter_px * (std::max(longest, kFitting) - kFitting));
  Figure figure{"fig08_gap_by_trial", "Sim-to-Real gap of every trial",
                options.width_px + labels_px, 150 + kRow_px * std::max(count, 3)};
  const std::size_t with_gap = CountWithGap(result), all = result.settings.size();
  std::string of = "gap (m)";
  if (settings.size() < all) of += fmt::format(", the {} worst of {} settings", count, all);
  if (settings.size() < all && with_gap < all) of += fmt::format(", {} with a gap", with_gap);
  // Long labels push the plot to the right; a legend centred on it would leave the page.
  const int key_lines =
      static_cast<int>(std::min<std::size_t>(names.size(), kMostTrialColours)) / 2 + 2;
  const std::string key = fmt::format(
      "set key at screen 0.5, screen 0.99 top center maxcols 2\nset tmargin {}\n", key_lines + 1);
  figure.plot = fmt::format(
      "{}{}set ytics ({})\nset xlabel {}\nset xrange [0:{:.9g}]\nset yrange "
      "[{:.9g}:-0.6]\n"
      "set arrow from {:.9g}, graph 0 to {:.9g}, graph 1 nohead lw 1.2 dt 2 lc rgb '#000000'\n{}",
      data, key, tics, Quoted(of), AxisEnd(1.03 * std::max(dots.largest_m, threshold_m)),
      count - 0.4, threshold_m, threshold_m, plot);
  return figure;
}

}  // namespace rift::report
