#include "rift/report/figures/figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "rift/report/figures/gnuplot_text.hpp"

namespace rift::report {
namespace {

using trajectory::StampedPose;
using trajectory::Trajectory;

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
constexpr int kBeside_px = 80;  // labels left and right of the axes
constexpr double kBodyHeight_m = 0.06;
constexpr double kArrow_m = 0.05;  // about the robot's radius
constexpr double kSpeedWindow_s = 0.06;
constexpr std::string_view kTruthColour = "#0072B2";
constexpr std::string_view kLoggedColour = "#D55E00";
constexpr std::string_view kStartColour = "#009E73";
constexpr std::string_view kEndColour = "#000000";

struct Range {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();

  void Cover(double value) {
    if (!std::isfinite(value)) return;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  double Length() const { return high - low; }
  void Widen(double by, double least) {
    const double half = std::max(Length() / 2.0 + by, least / 2.0), centre = (low + high) / 2.0;
    low = centre - half;
    high = centre + half;
  }
  std::string Text() const { return fmt::format("[{:.9g}:{:.9g}]", low, high); }
};

struct Extent {
  Range x_m, y_m;
};

Extent ExtentOf(const SimulatedTrial& trial) {
  Extent extent;
  const auto cover = [&](double x_m, double y_m) {
    extent.x_m.Cover(x_m);
    extent.y_m.Cover(y_m);
  };
  for (const Trajectory* path : {&trial.truth, &trial.logged}) {
    for (const StampedPose& pose : path->poses) cover(pose.x_m, pose.y_m);
  }
  for (const geometry::NamedPoint& point : trial.waypoints) {
    cover(point.p_in_world_m.x(), point.p_in_world_m.y());
  }
  extent.x_m.Widen(0.07, 0.2);
  extent.y_m.Widen(0.07, 0.3 * extent.x_m.Length());
  return extent;
}

// High enough for equal scales on both axes.
int Height_px(const ReportOptions& options, double width_m, double height_m, int around_px) {
  const double scale = (options.width_px - kBeside_px) / width_m;
  return std::clamp(static_cast<int>(scale * height_m) + around_px, 110, 700);
}

template <class Row>
std::string Block(const char* name, const std::vector<StampedPose>& poses, Row&& row) {
  DataBlock block(name);
  for (const StampedPose& pose : poses) block.Add(row(pose));
  return block.Text();
}

std::string AreaText(const SimulatedTrial& trial, const Extent& shown) {
  std::string text;
  for (const geometry::FloorArea& area : trial.areas) {
    const double left = std::max(area.x_min_m, shown.x_m.low);
    const double right = std::min(area.x_max_m, shown.x_m.high);
    const double low = std::max(area.y_min_m, shown.y_m.low);
    const double high = std::min(area.y_max_m, shown.y_m.high);
    if (!(left < right && low < high)) continue;
    text += fmt::format(
        "set object rectangle from {:.9g},{:.9g} to {:.9g},{:.9g} behind fc rgb '#E4ECF4' "
        "fs solid border lc rgb '#B0C4D8' lw 0.6\n",
        left, low, right, high);
    if (area.label.empty()) continue;
    text += fmt::format("set label {} at {:.9g},{:.9g} offset 0.5,-0.7 left tc rgb '#5A7896'\n",
                        Quoted(area.label), left, high);
  }
  return text;
}

std::string HeadingArrow(const StampedPose& pose, std::string_view colour) {
  if (!std::isfinite(pose.yaw_rad)) return "";
  const Eigen::Vector2d tip_m = pose.Position() + kArrow_m * pose.Planar().Forward();
  return fmt::format("set arrow from {:.9g},{:.9g} to {:.9g},{:.9g} front lw 2 lc rgb '{}'\n",
                     pose.x_m, pose.y_m, tip_m.x(), tip_m.y(), colour);
}

void AddWaypoints(const SimulatedTrial& trial, std::string* text, PlotCommand* plot) {
  if (trial.waypoints.empty()) return;
  DataBlock block("waypoints");
  for (const geometry::NamedPoint& point : trial.waypoints) {
    block.Add({point.p_in_world_m.x(), point.p_in_world_m.y()});
    *text += fmt::format("set label {} at {:.9g},{:.9g} center offset 0,-1.1 front\n",
                         Quoted(Shortened(point.name, 16)), point.p_in_world_m.x(),
                         point.p_in_world_m.y());
  }
  *text += block.Text();
  plot->Add(block.Name() + " using 1:2 with points pt 7 ps 0.9 lc rgb '#E6B800' title 'waypoints'");
}

Figure TopView(const SimulatedTrial& trial, const ReportOptions& options) {
  const Extent extent = ExtentOf(trial);
  const auto position = [](const StampedPose& p) { return std::vector{p.x_m, p.y_m}; };
  std::string text = Block("truth_xy", trial.truth.poses, position);
  PlotCommand plot;
  AddWaypoints(trial, &text, &plot);
  plot.Add(fmt::format("$truth_xy using 1:2 with lines lw 1.8 lc rgb '{}' title 'true path'",
                       kTruthColour));
  if (!trial.logged.poses.empty()) {
    text += Block("logged_xy", trial.logged.poses, position);
    plot.Add(fmt::format("$logged_xy using 1:2 with points pt 7 ps 0.3 lc rgb '{}' title 'logged'",
                         kLoggedColour));
  }
  text += HeadingArrow(trial.truth.poses.front(), kStartColour);
  text += HeadingArrow(trial.truth.poses.back(), kEndColour);
  plot.Add(fmt::format("keyentry with vectors lw 2 lc rgb '{}' title 'start'", kStartColour));
  plot.Add(fmt::format("keyentry with vectors lw 2 lc rgb '{}' title 'end'", kEndColour));
  Figure figure{"top_view", "The path from above", options.width_px,
                Height_px(options, extent.x_m.Length(), extent.y_m.Length(), 95)};
  figure.plot = fmt::format(
      "set size ratio -1\nset lmargin 9\nset rmargin 3\nset xlabel 'x (m)'\nset ylabel 'y (m)'\n"
      "set xrange {}\nset yrange {}\n{}{}{}",
      extent.x_m.Text(), extent.y_m.Text(), AreaText(trial, extent), text, plot.Text());
  return figure;
}

bool HasHeight(const Trajectory& path) {
  return std::any_of(path.poses.begin(), path.poses.end(),
                     [](const StampedPose& pose) { return std::isfinite(pose.z_m); });
}

Figure SideView(const SimulatedTrial& trial, const ReportOptions& options) {
  const Range x_m = ExtentOf(trial).x_m;
  Range z_m;
  DataBlock ground("ground");
  for (const Eigen::Vector2d& p : trial.ground_xz_m) {
    if (p.x() < x_m.low || p.x() > x_m.high) continue;
    ground.Add({p.x(), p.y()});
    z_m.Cover(p.y());
  }
  for (const StampedPose& pose : trial.truth.poses) z_m.Cover(pose.z_m);
  z_m.low -= 0.02;
  z_m.high += kBodyHeight_m;
  std::string data;
  PlotCommand plot;
  if (!ground.IsEmpty()) {
    data += ground.Text();
    plot.Add(fmt::format("{} using 1:2:({:.9g}) with filledcurves fc rgb '#D9C9B0' notitle",
                         ground.Name(), z_m.low));
    plot.Add(ground.Name() + " using 1:2 with lines lw 1.2 lc rgb '#5A4A32' title 'ground'");
  }
  if (HasHeight(trial.truth)) {
    data += Block("truth_xz", trial.truth.poses, [](const StampedPose& p) {
      return std::vector{p.x_m, p.z_m};
    });
    plot.Add(fmt::format("$truth_xz using 1:2 with lines lw 1.8 lc rgb '{}' title 'axle'",
                         kTruthColour));
  }
  Figure figure{"side_view", "The path from the side", options.width_px,
                Height_px(options, x_m.Length(), z_m.Length(), 95)};
  figure.plot = fmt::format(
      "set size ratio -1\nset lmargin 9\nset rmargin 3\nset xlabel 'x (m)'\nset ylabel 'z (m)'\n"
      "set xrange {}\nset yrange {}\nset ytics {:.9g}\n{}{}",
      x_m.Text(), z_m.Text(), z_m.Length() > 0.25 ? 0.1 : 0.05, data, plot.Text());
  return figure;
}

double Between_m(const StampedPose& a, const StampedPose& b) {
  const double climb_m = b.z_m - a.z_m;
  return std::hypot(b.x_m - a.x_m, b.y_m - a.y_m, std::isfinite(climb_m) ? climb_m : 0.0);
}

// Over a short window, so that the simulator's fine steps do not show as noise.
DataBlock SpeedBlock(const Trajectory& truth) {
  DataBlock speed("speed");
  const double start_s = truth.poses.front().t_s;
  std::size_t from = 0;
  double length_m = 0.0;
  std::vector<double> path_m{0.0};
  for (std::size_t i = 1; i < truth.poses.size(); ++i) {
    length_m += Between_m(truth.poses[i - 1], truth.poses[i]);
    path_m.push_back(length_m);
    const double now_s = truth.poses[i].t_s;
    while (from + 1 < i && now_s - truth.poses[from + 1].t_s >= kSpeedWindow_s) ++from;
    const double then_s = truth.poses[from].t_s;
    speed.Add({(now_s + then_s) / 2.0 - start_s, (length_m - path_m[from]) / (now_s - then_s)});
  }
  return speed;
}

Figure TimePlot(const char* name, const char* title, const char* label, double duration_s,
                const ReportOptions& options) {
  Figure figure{name, title, options.width_px, options.width_px * 2 / 5};
  figure.plot = fmt::format(
      "set lmargin 9\nset rmargin 3\nset xlabel 'time since the start (s)'\nset ylabel '{}'\n"
      "set xrange [0:{:.9g}]\n",
      label, duration_s);
  return figure;
}

Figure SpeedPlot(const SimulatedTrial& trial, const ReportOptions& options) {
  Figure figure =
      TimePlot("speed", "Speed over time", "speed (m/s)", trial.truth.Duration_s(), options);
  const DataBlock speed = SpeedBlock(trial.truth);
  figure.plot += fmt::format(
      "set yrange [0:*]\n{}plot {} using 1:2 with lines lw 1.6 lc rgb '{}' title 'true speed'\n",
      speed.Text(), speed.Name(), kTruthColour);
  return figure;
}

const Trajectory* WithPowers(const SimulatedTrial& trial) {
  for (const Trajectory* log : {&trial.truth, &trial.logged}) {
    for (const trajectory::Channel& channel : log->channels) {
      if (channel.name == "power_left" && !channel.values.empty()) return log;
    }
  }
  return nullptr;
}

Figure PowerPlot(const SimulatedTrial& trial, const Trajectory& log, const ReportOptions& options) {
  const double start_s = trial.truth.poses.front().t_s;
  Figure figure = TimePlot("power", "Powers over time", "power (share of full)",
                           trial.truth.Duration_s(), options);
  PlotCommand plot;
  for (const trajectory::Channel& channel : log.channels) {
    const bool left = channel.name == "power_left";
    if (!left && channel.name != "power_right") continue;
    DataBlock block(channel.name);
    for (std::size_t i = 0; i < log.poses.size(); ++i) {
      block.Add(
          {log.poses[i].t_s - start_s, i < channel.values.size() ? channel.values[i] : kUnknown});
    }
    figure.plot += block.Text();
    plot.Add(fmt::format("{} using 1:2 with steps lw 1.4 lc rgb '{}' title '{}'", block.Name(),
                         SeriesColour(left ? 2 : 3, 4), left ? "left wheel" : "right wheel"));
  }
  figure.plot += plot.Text();
  return figure;
}

}  // namespace

Figure SimulationFigure(const SimulatedTrial& trial, const ReportOptions& options) {
  if (trial.truth.poses.size() < 2) {
    throw std::invalid_argument(
        fmt::format("the figure of a simulated trial needs at least two true poses, but there are "
                    "{}",
                    trial.truth.poses.size()));
  }
  std::vector<Figure> parts{TopView(trial, options)};
  if (HasHeight(trial.truth)) parts.push_back(SideView(trial, options));
  parts.push_back(SpeedPlot(trial, options));
  if (const Trajectory* log = WithPowers(trial)) parts.push_back(PowerPlot(trial, *log, options));
  return Stack("simulation", "Simulated trial " + trial.name + ": path, height, speed and powers",
               parts);
}

}  // namespace rift::report
