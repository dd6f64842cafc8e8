#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "rift/report/figures/gnuplot_text.hpp"
#include "rift/statistics/quantile.hpp"
#include "sweep_plots.hpp"

namespace rift::report {
namespace {

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
  const std::string threshold = Number(threshold_m);
  const auto add = [&](const DataBlock& block, const std::string& style, const std::string& title) {
    if (block.IsEmpty()) return;
    *data += block.Text();
    plot.Add(
        fmt::format("{} using 1:2 with points {} title {}", block.Name(), style, Quoted(title)));
  };
  add(scatter.pass, fmt::format("pt 6 ps 0.45 lc rgb '{}'", kPassColour),
      fmt::format("gap up to {} m", threshold));
  add(scatter.fail, fmt::format("pt 7 ps 0.45 lc rgb '{}'", kFailColour),
      fmt::format("gap above {} m", threshold));
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
