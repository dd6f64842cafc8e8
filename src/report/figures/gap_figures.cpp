#include "rift/report/figures/figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <stdexcept>

#include "rift/report/figures/gnuplot_text.hpp"

namespace rift::report {
namespace {

constexpr std::size_t kLongestName = 36;
constexpr int kCurvePoints = 1000;  // more than a column has pixels

void RequirePairs(const std::vector<ComparedPair>& pairs) {
  if (pairs.empty()) throw std::invalid_argument("a gap figure needs at least one pair of paths");
}

const ComparedPair& Worst(const std::vector<ComparedPair>& pairs) {
  return *std::max_element(pairs.begin(), pairs.end(), [](const auto& a, const auto& b) {
    return a.comparison.gap_m < b.comparison.gap_m;
  });
}

std::string PairColour(int index, int count) {
  // The simulated path is orange, so the real ones skip that colour.
  return SeriesColour(index == 0 ? 0 : index + 1, std::max(count + 1, 2));
}

constexpr std::string_view kSimColour = "#E69F00";

// Every k-th of n samples and always the last.
template <class Draw>
void ForSomeSamples(std::size_t n, Draw&& draw) {
  const std::size_t step = std::max<std::size_t>(1, n / kCurvePoints);
  for (std::size_t i = 0; i < n; i += step) draw(i);
  if (n > 0 && (n - 1) % step != 0) draw(n - 1);
}

DataBlock PathBlock(std::string name, const std::vector<Eigen::Vector2d>& path_m) {
  DataBlock block(std::move(name));
  ForSomeSamples(path_m.size(), [&](std::size_t i) { block.Add({path_m[i].x(), path_m[i].y()}); });
  return block;
}

DataBlock PointBlock(std::string name, const std::vector<Eigen::Vector2d>& points_m) {
  DataBlock block(std::move(name));
  for (const Eigen::Vector2d& p : points_m) block.Add({p.x(), p.y()});
  return block;
}

std::size_t SampleAt(const gap::ErrorProfile& profile, double u) {
  const auto distance = [u](double a, double b) { return std::abs(a - u) < std::abs(b - u); };
  return std::min_element(profile.u.begin(), profile.u.end(), distance) - profile.u.begin();
}

struct Box {
  Eigen::Vector2d low{HUGE_VAL, HUGE_VAL}, high{-HUGE_VAL, -HUGE_VAL};

  void Cover(const std::vector<Eigen::Vector2d>& points) {
    for (const Eigen::Vector2d& p : points) {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
  }
  void Pad() {
    const double span = std::max((high - low).maxCoeff(), 1e-3);
    const Eigen::Vector2d centre = 0.5 * (low + high);
    // At least a quarter as high as wide: a straight drive still gets a readable plot.
    const Eigen::Vector2d half =
        (0.5 * (high - low)).cwiseMax(0.125 * span) + Eigen::Vector2d::Constant(0.06 * span);
    low = centre - half;
    high = centre + half;
  }
};

Box Surroundings(const std::vector<ComparedPair>& pairs) {
  Box box;
  for (const ComparedPair& pair : pairs) {
    box.Cover(pair.profile.sim_m);
    box.Cover(pair.profile.real_m);
    box.Cover(pair.waypoints_m);
  }
  box.Pad();
  return box;
}

std::string Mark(const DataBlock& block, std::string_view style, std::string_view title) {
  return fmt::format("{} using 1:2 with {} title {}", block.Name(), style, Quoted(title));
}

void AddPaths(const std::vector<ComparedPair>& pairs, std::string* data, PlotCommand* plot) {
  const ComparedPair& worst = Worst(pairs);
  const DataBlock sim = PathBlock("sim_path", worst.profile.sim_m);
  *data += sim.Text();
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const DataBlock real = PathBlock(fmt::format("real_path_{}", i), pairs[i].profile.real_m);
    *data += real.Text();
    plot->Add(Mark(real,
                   fmt::format("lines lw 1.8 lc rgb '{}'",
                               PairColour(static_cast<int>(i), static_cast<int>(pairs.size()))),
                   Shortened(pairs[i].real, kLongestName)));
  }
  plot->Add(Mark(sim, fmt::format("lines lw 1.8 lc rgb '{}'", kSimColour),
                 Shortened(worst.sim, kLongestName)));
}

void AddMarks(const std::vector<ComparedPair>& pairs, std::string* data, PlotCommand* plot) {
  const ComparedPair& worst = Worst(pairs);
  std::vector<Eigen::Vector2d> starts = {worst.profile.sim_m.front()};
  std::vector<Eigen::Vector2d> ends = {worst.profile.sim_m.back()};
  for (const ComparedPair& pair : pairs) {
    starts.push_back(pair.profile.real_m.front());
    ends.push_back(pair.profile.real_m.back());
  }
  const std::size_t at = SampleAt(worst.profile, worst.comparison.gap_u);
  const DataBlock gap = PointBlock("largest", {worst.profile.sim_m[at], worst.profile.real_m[at]});
  const DataBlock start = PointBlock("starts", starts), end = PointBlock("ends", ends);
  *data += gap.Text() + start.Text() + end.Text();
  plot->Add(Mark(gap, "linespoints lw 1.5 pt 7 ps 0.4 lc rgb '#D55E00'",
                 fmt::format("gap {:.4f} m", worst.comparison.gap_m)));
  plot->Add(Mark(start, "points pt 6 ps 1.0 lw 1.5 lc rgb '#000000'", "start"));
  plot->Add(Mark(end, "points pt 5 ps 0.7 lc rgb '#000000'", "end"));
  const DataBlock waypoints = PointBlock("waypoints", worst.waypoints_m);
  if (waypoints.IsEmpty()) return;
  *data += waypoints.Text();
  plot->Add(Mark(waypoints, "points pt 1 ps 1.2 lw 1.5 lc rgb '#777777'", "waypoints"));
}

// The samples that count: skip_start leaves out the first ones.
std::vector<double> CountedErrors_m(const gap::ErrorProfile& profile, const gap::GapOptions& gap) {
  const auto first = std::lower_bound(profile.u.begin(), profile.u.end(), gap.skip_start);
  return {profile.error_m.begin() + (first - profile.u.begin()), profile.error_m.end()};
}

std::string ErrorTitle(const ComparedPair& pair, std::size_t pairs) {
  if (pairs == 1) return "error";
  return Shortened(pair.real, kLongestName);
}

}  // namespace

ComparedPair ComparePair(std::string sim_name, const trajectory::Trajectory& sim,
                         std::string real_name, const trajectory::Trajectory& real,
                         const gap::GapOptions& gap) {
  gap::GapOptions whole = gap;
  whole.skip_start = 0.0;
  ComparedPair pair{std::move(sim_name), std::move(real_name), gap::Compare(sim, real, gap),
                    gap::ProfileAlong(sim, real, whole), LoggedWaypoints(real)};
  pair.is_in_space = gap.IsInSpace();
  if (pair.waypoints_m.empty()) pair.waypoints_m = LoggedWaypoints(sim);
  return pair;
}

std::vector<Eigen::Vector2d> LoggedWaypoints(const trajectory::Trajectory& trajectory) {
  std::vector<Eigen::Vector2d> waypoints_m;
  for (const trajectory::StampedPose& pose : trajectory.poses) {
    const Eigen::Vector2d target_m(pose.target_x_m, pose.target_y_m);
    if (!target_m.allFinite()) continue;
    if (waypoints_m.empty() || waypoints_m.back() != target_m) waypoints_m.push_back(target_m);
  }
  return waypoints_m;
}

Figure OverlayFigure(const std::vector<ComparedPair>& pairs, const ReportOptions& options) {
  RequirePairs(pairs);
  const Box box = Surroundings(pairs);
  const Eigen::Vector2d extent = box.high - box.low;
  std::string data;
  PlotCommand plot;
  AddPaths(pairs, &data, &plot);
  AddMarks(pairs, &data, &plot);
  Figure figure{"overlay", "The simulated and the real path in the plane", options.width_px};
  // About 80 px beside the axes and 110 px above and below them are labels and the legend.
  figure.height_px = std::clamp(
      static_cast<int>((figure.width_px - 80) * extent.y() / extent.x()) + 110, 220, 640);
  figure.plot = fmt::format(
      "{}set size ratio -1\nset xlabel '{}'\nset ylabel 'y (m)'\n"
      "set xrange [{:.9g}:{:.9g}]\nset yrange [{:.9g}:{:.9g}]\n{}",
      data,
      pairs.front().is_in_space ? "x (m), seen from above; the gap counts heights too" : "x (m)",
      box.low.x(), box.high.x(), box.low.y(), box.high.y(), plot.Text());
  return figure;
}

Figure ErrorFigure(const std::vector<ComparedPair>& pairs, const gap::GapOptions& gap,
                   const ReportOptions& options) {
  RequirePairs(pairs);
  const ComparedPair& worst = Worst(pairs);
  std::string data;
  PlotCommand plot;
  DataBlock maxima("maxima");
  double largest_m = gap.threshold_m;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const gap::ErrorProfile& profile = pairs[i].profile;
    DataBlock curve(fmt::format("error_{}", i));
    ForSomeSamples(profile.u.size(), [&](std::size_t k) {
      curve.Add({profile.u[k], profile.error_m[k]});
    });
    data += curve.Text();
    plot.Add(Mark(curve,
                  fmt::format("lines lw 1.8 lc rgb '{}'",
                              PairColour(static_cast<int>(i), static_cast<int>(pairs.size()))),
                  ErrorTitle(pairs[i], pairs.size())));
    maxima.Add({pairs[i].comparison.gap_u, pairs[i].comparison.gap_m});
    largest_m = std::max(largest_m, pairs[i].comparison.gap_m);
  }
  plot.Add(ThresholdLine(gap.threshold_m));
  plot.Add(Mark(maxima, "points pt 7 ps 0.7 lc rgb '#D55E00'",
                fmt::format("{}gap {:.4f} m at u = {:.2f}", pairs.size() > 1 ? "largest " : "",
                            worst.comparison.gap_m, worst.comparison.gap_u)));
  Figure figure{"fig09_error_along_path", "Position error along the normalised path length",
                options.width_px, options.width_px * 3 / 5};
  figure.plot = fmt::format(
      "{}{}set xlabel 'normalised arc length u'\nset ylabel 'position error (m)'\n"
      "set xrange [0:1]\nset yrange [0:{:.9g}]\n"
      "set arrow from {:.9g}, graph 0 to {:.9g},{:.9g} nohead dt 3 lw 1.2 lc rgb '#D55E00'\n",
      data, maxima.Text(), AxisEnd(1.05 * largest_m), worst.comparison.gap_u,
      worst.comparison.gap_u, worst.comparison.gap_m);
  if (gap.skip_start > 0.0) {
    figure.plot += fmt::format(
        "set object rectangle from 0, graph 0 to {:.9g}, graph 1 behind fc rgb '#EEEEEE' "
        "fs solid noborder\nset label 'left out' at {:.9g}, graph 0.95 center "
        "textcolor rgb '#777777'\n",
        gap.skip_start, gap.skip_start / 2);
  }
  figure.plot += plot.Text();
  return figure;
}

Figure ErrorCdfFigure(const std::vector<ComparedPair>& pairs, const gap::GapOptions& gap,
                      const ReportOptions& options) {
  RequirePairs(pairs);
  std::string data;
  PlotCommand plot;
  double largest_m = gap.threshold_m;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    std::vector<double> errors_m = CountedErrors_m(pairs[i].profile, gap);
    std::sort(errors_m.begin(), errors_m.end());
    DataBlock curve(fmt::format("cdf_{}", i));
    const double n = static_cast<double>(errors_m.size());
    ForSomeSamples(errors_m.size(), [&](std::size_t k) {
      curve.Add({errors_m[k], 100.0 * static_cast<double>(k + 1) / n});
    });
    data += curve.Text();
    plot.Add(Mark(curve,
                  fmt::format("lines lw 1.8 lc rgb '{}'",
                              PairColour(static_cast<int>(i), static_cast<int>(pairs.size()))),
                  ErrorTitle(pairs[i], pairs.size())));
    largest_m = std::max(largest_m, errors_m.back());
  }
  const DataBlock threshold =
      PointBlock("threshold", {{gap.threshold_m, 0.0}, {gap.threshold_m, 100.0}});
  plot.Add(Mark(threshold, "lines lw 1.2 dt 2 lc rgb '#000000'",
                fmt::format("threshold {} m", Number(gap.threshold_m))));
  Figure figure{"error_cdf", "Share of the path whose error stays below a value", options.width_px,
                options.width_px * 3 / 5};
  figure.plot = fmt::format(
      "{}{}set xlabel 'position error (m)'\nset ylabel 'share of the path (%)'\n"
      "set xrange [0:{:.9g}]\nset yrange [0:100]\n{}",
      data, threshold.Text(), AxisEnd(1.05 * largest_m), plot.Text());
  return figure;
}

std::vector<Figure> GapFigures(const std::vector<ComparedPair>& pairs, const gap::GapOptions& gap,
                               const ReportOptions& options) {
  return {OverlayFigure(pairs, options), ErrorFigure(pairs, gap, options),
          ErrorCdfFigure(pairs, gap, options)};
}

Figure GapFigure(const gap::GapResult& result) {
  const auto name_of = [](const std::string& path) {
    return std::filesystem::path(path).stem().string();
  };
  std::vector<ComparedPair> pairs;
  for (size_t i = 0; i < result.trials.size(); ++i) {
    pairs.push_back(ComparePair(name_of(result.sim_path), result.sim,
                                name_of(result.trials[i].path), result.reals[i], result.options));
  }
  return Stack("gap", "paths, error over u and its distribution",
               GapFigures(pairs, result.options));
}

}  // namespace rift::report
