#include "rift/report/figures/figures.hpp"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "rift/report/figures/gnuplot_text.hpp"

namespace rift::report {
namespace {

using trajectory::Trajectory;

constexpr std::string_view kBeforeColour = "#999999";
constexpr std::string_view kAfterColour = "#0072B2";
constexpr std::string_view kRealColour = "#D55E00";

/// Several paths in one block, a gap between two.
std::string PathBlock(const std::string& name, const std::vector<Trajectory>& paths) {
  std::string rows;
  for (const Trajectory& path : paths) {
    for (const trajectory::StampedPose& pose : path.poses) {
      rows += fmt::format("{:.6f} {:.6f}\n", pose.x_m, pose.y_m);
    }
    rows += '\n';
  }
  return "$" + name + " << EOD\n" + rows + "EOD\n";
}

void AddPaths(const std::string& name, const std::vector<Trajectory>& paths,
              std::string_view colour, double width, const std::string& title, std::string* data,
              PlotCommand* plot) {
  if (paths.empty()) return;
  *data += PathBlock(name, paths);
  plot->Add(fmt::format("${} using 1:2 with lines lw {} lc rgb '{}' title {}", name, width, colour,
                        Quoted(title)));
}

/// Extent of several paths.
struct Extent {
  Eigen::Array2d low = Eigen::Array2d::Constant(HUGE_VAL), high = -low;

  void Cover(const std::vector<Trajectory>& paths) {
    for (const Trajectory& path : paths) {
      for (const trajectory::StampedPose& pose : path.poses) {
        low = low.min(pose.Position().array());
        high = high.max(pose.Position().array());
      }
    }
  }
  Eigen::Array2d Size_m() const { return (high - low).max(1e-3); }
};

/// 1, 2 or 5 times a power of ten, at least `least`.
double RoundStep(double least) {
  const double decade = std::pow(10.0, std::floor(std::log10(least)));
  for (const double round : {1.0, 2.0, 5.0}) {
    if (least <= round * decade * (1.0 + 1e-12)) return round * decade;
  }
  return 10.0 * decade;
}

}  // namespace

Figure CalibrationGapFigure(const std::vector<CalibratedTrial>& trials,
                            const ReportOptions& options) {
  DataBlock fitted("fitted"), held_out("held_out");
  double largest_mm = 0.0;
  for (const CalibratedTrial& trial : trials) {
    const double before_mm = 1e3 * trial.gap_before_m, after_mm = 1e3 * trial.gap_after_m;
    if (std::isnan(before_mm) || std::isnan(after_mm)) continue;
    (trial.is_held_out ? held_out : fitted).Add({before_mm, after_mm});
    largest_mm = std::max({largest_mm, before_mm, after_mm});
  }
  if (fitted.IsEmpty() && held_out.IsEmpty()) {
    throw std::invalid_argument("no trial has a gap both before and after the fit");
  }
  const double end_mm = AxisEnd(1.05 * largest_mm);
  Figure figure{"calibration_gaps",
                "Gap of each trial before and after the fit; below the line the fit helped",
                options.width_px, options.width_px * 3 / 4};
  PlotCommand plot;
  plot.Add("x with lines lw 1 dt 2 lc rgb '#000000' title 'as before'");
  if (!fitted.IsEmpty()) {
    plot.Add(fmt::format("{} using 1:2 with points pt 7 ps 0.7 lc rgb '{}' title 'fitted'",
                         fitted.Name(), kAfterColour));
    figure.plot += fitted.Text();
  }
  if (!held_out.IsEmpty()) {
    plot.Add(fmt::format("{} using 1:2 with points pt 4 ps 0.9 lw 1.5 lc rgb '{}' title 'held out'",
                         held_out.Name(), kRealColour));
    figure.plot += held_out.Text();
  }
  figure.plot += fmt::format(
      "set size ratio -1\nset xlabel 'gap of the mean simulated path before (mm)'\n"
      "set ylabel 'after the fit (mm)'\nset xrange [0:{0:.9g}]\nset yrange [0:{0:.9g}]\n{1}",
      end_mm, plot.Text());
  return figure;
}

Figure CalibrationPathFigure(const CalibratedPaths& paths, const ReportOptions& options) {
  Extent extent;
  extent.Cover(paths.before);
  extent.Cover(paths.after);
  extent.Cover({paths.real});
  const Eigen::Array2d size_m = extent.Size_m();
  // About so many pixels beside and below the axes are labels and the legend.
  constexpr int kBeside_px = 80, kBelow_px = 120;
  constexpr double kLabel_px = 16.0;
  Figure figure{"calibration_paths", "Paths of " + paths.name, options.width_px};
  const int across_px = figure.width_px - kBeside_px;
  figure.height_px = std::clamp(static_cast<int>(across_px * size_m.y() / size_m.x()) + kBelow_px,
                                options.width_px * 9 / 20, 640);
  const double px_per_m =
      std::min(across_px / size_m.x(), (figure.height_px - kBelow_px) / size_m.y());
  PlotCommand plot;
  std::string data;
  AddPaths("before", paths.before, kBeforeColour, 1.0, "simulated before", &data, &plot);
  AddPaths("after", paths.after, kAfterColour, 1.3, "after the fit", &data, &plot);
  AddPaths("real", {paths.real}, kRealColour, 1.8, "robot, " + paths.name, &data, &plot);
  figure.plot = fmt::format(
      "set size ratio -1\nset xlabel 'x (m)'\nset ylabel 'y (m)'\nset ytics {:.9g}\n{}{}",
      RoundStep(kLabel_px / px_per_m), data, plot.Text());
  return figure;
}

std::optional<Figure> CalibrationFigure(const std::string& name,
                                        const sweep::CalibrationReport& report) {
  std::vector<CalibratedTrial> trials;
  bool has_gaps = false;
  for (const sweep::CalibrationTrial& trial : report.trials) {
    trials.push_back({trial.level, trial.is_held_out, trial.gap_before_m, trial.gap_after_m});
    has_gaps = has_gaps || (!std::isnan(trial.gap_before_m) && !std::isnan(trial.gap_after_m));
  }
  if (!has_gaps) return std::nullopt;
  std::vector<Figure> parts{CalibrationGapFigure(trials)};
  if (!report.shown_real.poses.empty()) {
    const sweep::CalibrationTrial& shown = report.trials[report.shown];
    parts.push_back(CalibrationPathFigure(
        {.name = fmt::format("{}{}trial {}{}", shown.level, shown.level.empty() ? "" : ", ",
                             shown.trial, shown.is_held_out ? " (held out)" : ""),
         .real = report.shown_real,
         .before = report.shown_before,
         .after = report.shown_after}));
  }
  return Stack("calibration", name + ": before and after the fit", parts);
}

}  // namespace rift::report
