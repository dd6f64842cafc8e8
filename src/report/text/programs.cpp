#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

#include "rift/geometry/pose2.hpp"
#include "rift/report/text/text.hpp"
#include "rift/sweep/falsify/result.hpp"

namespace rift::report {
namespace {

using odometry::CellMeasures;
using odometry::RunMeasures;

std::string Metres(double value_m) {
  return std::isfinite(value_m) ? fmt::format("{:.4f} m", value_m) : "unknown";
}

std::string Percent(double share) {
  return std::isfinite(share) ? fmt::format("{:.1f} %", 100.0 * share) : "unknown";
}

std::string CellText(const CellMeasures& cell, double value, const std::string& format) {
  if (cell.runs == 0) return "no run";
  if (!cell.DidMove()) return "did not move";
  if (!std::isfinite(value)) return "-";
  return fmt::format(fmt::runtime(format), value);
}

/// A table of figure 14: a column for each level of the main factor, a line for each combination of
/// the others.
std::string Table(const std::vector<experiment::Parameter>& parameters,
                  const std::vector<sweep::ProgramCell>& cells, const std::string& title,
                  const std::string& format,
                  const std::function<double(const CellMeasures&)>& value) {
  const sweep::FactorSplit split = sweep::SplitFactors(parameters);
  std::vector<std::string> columns, lines;
  std::map<std::pair<std::string, std::string>, std::string> texts;
  const auto place = [](std::vector<std::string>& list, const std::string& name) {
    if (std::find(list.begin(), list.end(), name) == list.end()) list.push_back(name);
  };
  for (const sweep::ProgramCell& cell : cells) {
    const std::string column = sweep::CombinationLabel(cell.theta, {split.main_factor});
    const std::string line =
        split.others.empty() ? "all" : sweep::CombinationLabel(cell.theta, split.others);
    place(columns, column);
    place(lines, line);
    texts[{line, column}] = CellText(cell.measures, value(cell.measures), format);
  }
  size_t first = split.others_name.size();
  for (const std::string& line : lines) first = std::max(first, line.size());
  std::vector<size_t> widths;
  std::string text = fmt::format("\n{}\n{:<{}}", title, split.others_name, first);
  for (const std::string& column : columns) {
    size_t width = column.size();
    for (const std::string& line : lines) width = std::max(width, texts[{line, column}].size());
    widths.push_back(width);
    text += fmt::format("  {:>{}}", column, width);
  }
  text += '\n';
  for (const std::string& line : lines) {
    text += fmt::format("{:<{}}", line, first);
    for (size_t i = 0; i < columns.size(); ++i) {
      text += fmt::format("  {:>{}}", texts[{line, columns[i]}], widths[i]);
    }
    text += '\n';
  }
  return text;
}

std::string EstimateText(const char* name, const odometry::Estimate& estimate, double scale,
                         const char* unit, int digits) {
  if (!estimate.is_told) return fmt::format("  {:<18} not told by these runs\n", name);
  return fmt::format("  {:<18} {:.{}f}{} [{:.{}f}, {:.{}f}]\n", name, scale * estimate.value,
                     digits, unit, scale * estimate.interval.low, digits,
                     scale * estimate.interval.high, digits);
}

std::string RunText(const odometry::OdometryResult::Run& run) {
  const RunMeasures& m = run.measures;
  std::string text = run.name + "\n";
  if (!m.did_move) return text + "  did not move\n";
  text += fmt::format("  way                   {}\n", Metres(m.length_m));
  if (std::isfinite(m.deviation_m)) {
    text +=
        fmt::format("  camera from program   mean {}, largest {}, end {}\n", Metres(m.deviation_m),
                    Metres(m.largest_deviation_m), Metres(m.end_error_m));
  } else if (std::isfinite(m.end_error_m)) {  // of a program that only turns
    text += fmt::format("  camera from program   end {}\n", Metres(m.end_error_m));
  }
  if (std::isfinite(m.odometry_gap_m)) {
    const std::string end =
        std::isfinite(m.drift_per_m)
            ? fmt::format("end {} ({} of the way), ", Metres(m.drift_per_m * m.length_m),
                          Percent(m.drift_per_m))
            : "";
    text += fmt::format("  odometry from camera  {}largest {}, turned {:+.2f} deg more\n", end,
                        Metres(m.odometry_gap_m), geometry::DegFromRad(m.yaw_drift_rad));
    text += fmt::format("  slip of the wheels    left {}, right {}\n", Percent(m.slip_left),
                        Percent(m.slip_right));
  }
  return text;
}

}  // namespace

std::string ProgramText(const std::vector<experiment::Parameter>& parameters,
                        const std::vector<sweep::ProgramCell>& cells) {
  if (cells.empty() || parameters.empty()) return "";
  const auto table = [&](const std::string& title, const std::string& format,
                         const std::function<double(const CellMeasures&)>& value) {
    return Table(parameters, cells, title, format, value);
  };
  std::string text = table("mean distance from the programmed path (m)", "{:.4f}",
                           [](const CellMeasures& cell) { return cell.deviation_m; }) +
                     table("spread of the repeats (m)", "{:.4f}",
                           [](const CellMeasures& cell) { return cell.spread_m; }) +
                     table("drift of the odometry (% of the way)", "{:.1f}",
                           [](const CellMeasures& cell) { return 100.0 * cell.drift_per_m; }) +
                     table("slip of the left wheel (%)", "{:.1f}",
                           [](const CellMeasures& cell) { return 100.0 * cell.slip_left; }) +
                     table("slip of the right wheel (%)", "{:.1f}",
                           [](const CellMeasures& cell) { return 100.0 * cell.slip_right; });
  return text + odometry::SpreadText() + "\n";
}

std::string OdometryText(const odometry::OdometryResult& result) {
  std::string text;
  for (const odometry::OdometryResult::Run& run : result.runs) text += RunText(run);
  if (result.cell) {
    const CellMeasures& cell = *result.cell;
    text += fmt::format("{} of {} runs of one program moved\n", cell.moved, cell.runs);
    if (cell.moved > 0 && std::isfinite(cell.deviation_m)) {
      text += fmt::format("  distance from it      mean {} [{:.4f}, {:.4f}]\n",
                          Metres(cell.deviation_m), cell.deviation_interval_m.low,
                          cell.deviation_interval_m.high);
      text += fmt::format("  spread                {}\n{}\n", Metres(cell.spread_m),
                          odometry::SpreadText());
    }
  }
  if (result.umbmark) {
    const odometry::Umbmark& u = *result.umbmark;
    text += fmt::format(
        "UMBmark: odometry ends at ({:+.4f}, {:+.4f}) m of the camera's end after {} run(s) "
        "counter-clockwise, ({:+.4f}, {:+.4f}) m after {} clockwise; systematic error {}\n",
        u.ccw_m.x(), u.ccw_m.y(), u.ccw_runs, u.cw_m.x(), u.cw_m.y(), u.cw_runs,
        Metres(u.largest_m));
  }
  if (result.calibration) {
    const odometry::OdometryCalibration& found = *result.calibration;
    text += fmt::format("calibrated from {} windows of {} run(s), {:g} % intervals\n",
                        found.windows, found.runs, 100.0 * result.confidence);
    text += EstimateText("wheel radius", found.wheel_radius_m, 1e3, " mm", 3);
    text += EstimateText("right over left", found.right_over_left, 1.0, "", 5);
    text += EstimateText("track", found.track_m, 1e3, " mm", 2);
    text += EstimateText("tag ahead of axle", found.tag_ahead_m, 1e3, " mm", 1);
    text += fmt::format(
        "to use it: --set hardware.odometry.drive.wheel_radius_m={:.6f} --set "
        "hardware.odometry.right_over_left={:.6f}{}\n",
        found.wheel_radius_m.value, found.right_over_left.value,
        found.track_m.is_told
            ? fmt::format(" --set hardware.odometry.drive.track_m={:.6f}", found.track_m.value)
            : "");
  }
  return text;
}

}  // namespace rift::report
