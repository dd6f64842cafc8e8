#include "calibrate_output.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "files.hpp"
#include "json_fields.hpp"
#include "likeness_output.hpp"
#include "rift/report/figures/calibration_figure.hpp"

namespace rift::commands {
namespace {

using nlohmann::ordered_json;
using sweep::CalibratedParameter;

constexpr double kWorthTelling = 0.7;  // of a correlation, in the text
constexpr double kDegPerRad = 57.29577951308232;

std::string Number(double value, int decimals) {
  return std::isnan(value) ? "-" : fmt::format("{:.{}f}", value, decimals);
}

std::string Change(double before, double after, int decimals) {
  return Number(before, decimals) + " > " + Number(after, decimals);
}

std::string ParameterText(const sweep::Calibration& fit) {
  size_t width = 9;
  for (const CalibratedParameter& p : fit.parameters)
    width = std::max(width, p.parameter.key.size());
  std::string text = fmt::format("{:<{}}  {:>9}  {:>9}  {:<22}  {}\n", "parameter", width, "start",
                                 "value", "interval", "flag");
  for (const CalibratedParameter& p : fit.parameters) {
    text += fmt::format("{:<{}}  {:>9.4g}  {:>9.4g}  {:<22}  {}\n", p.parameter.key, width,
                        p.parameter.start, p.value, fmt::format("[{:.4g}, {:.4g}]", p.low, p.high),
                        FlagOf(p));
  }
  return text;
}

std::string CorrelationText(const sweep::Calibration& fit) {
  std::string text;
  for (Eigen::Index a = 0; a < fit.correlation.rows(); ++a) {
    for (Eigen::Index b = 0; b < a; ++b) {
      if (!(std::abs(fit.correlation(a, b)) >= kWorthTelling)) continue;
      text +=
          fmt::format("correlated {:+.2f}: {} and {}; the logs tell their combination best\n",
                      fit.correlation(a, b), fit.parameters[static_cast<size_t>(b)].parameter.key,
                      fit.parameters[static_cast<size_t>(a)].parameter.key);
    }
  }
  return text;
}

std::string JudgedText(const std::vector<sweep::JudgedGroup>& judged) {
  std::string text = fmt::format(
      "before > after the fit, whole paths; ratios are simulated / real, 1 is like the robot\n"
      "{:<10} {:<8}  {:>13}  {:>8}  {:>13}  {:>12}  {:>12}  {:>22}  {:>14}  {:>9}\n",
      "", "", "gap_mm", "real_mm", "mean_path_mm", "spread", "weave", "delay_s (real)", "speed",
      "missed");
  for (const sweep::JudgedGroup& group : judged) {
    const gap::Likeness &before = group.before.path, &after = group.after.path;
    text += fmt::format(
        "{:<10} {:<8}  {:>13}  {:>8}  {:>13}  {:>12}  {:>12}  {:>22}  {:>14}  {:>9}\n", group.level,
        group.side, Change(1e3 * before.mean_gap_m, 1e3 * after.mean_gap_m, 1),
        Number(1e3 * after.spread_m.real, 1),
        Change(1e3 * before.mean_path_gap_m, 1e3 * after.mean_path_gap_m, 1),
        Change(before.spread_m.Ratio(), after.spread_m.Ratio(), 2),
        Change(before.weave_m.Ratio(), after.weave_m.Ratio(), 2),
        fmt::format("{} ({})",
                    Change(group.before.loop_delay_s.sim, group.after.loop_delay_s.sim, 3),
                    Number(group.after.loop_delay_s.real, 3)),
        Change(before.speed_mps.Ratio(), after.speed_mps.Ratio(), 3),
        fmt::format("{} > {}", group.before.failed_runs, group.after.failed_runs));
  }
  return text +
         "missed: runs that did not reach the end, or only after circling about a waypoint\n";
}

std::string ErrorText(const sweep::CalibrationReport::Errors& errors) {
  const sweep::ErrorStructure &b = errors.before, &a = errors.after;
  return fmt::format(
      "errors over {:.2f} s, {}, before > after: ahead {} mm (mean {}), sideways {} mm (mean {}), "
      "turn {} deg (mean {})\n"
      "  lag: the simulator turns {} s after the robot\n"
      "  side: turn off by {} deg turning left, {} deg turning right\n"
      "  frequency: strongest at {} Hz with {} of the variance\n",
      a.horizon_s, errors.side, Change(1e3 * b.ahead_m, 1e3 * a.ahead_m, 1),
      Change(1e3 * b.ahead_bias_m, 1e3 * a.ahead_bias_m, 1),
      Change(1e3 * b.left_m, 1e3 * a.left_m, 2),
      Change(1e3 * b.left_bias_m, 1e3 * a.left_bias_m, 2),
      Change(kDegPerRad * b.turned_rad, kDegPerRad * a.turned_rad, 2),
      Change(kDegPerRad * b.turned_bias_rad, kDegPerRad * a.turned_bias_rad, 2),
      Change(b.lag_s, a.lag_s, 2),
      Change(kDegPerRad * b.turning_left_rad, kDegPerRad * a.turning_left_rad, 2),
      Change(kDegPerRad * b.turning_right_rad, kDegPerRad * a.turning_right_rad, 2),
      Change(b.frequency_hz, a.frequency_hz, 2), Change(b.frequency_share, a.frequency_share, 2));
}

ordered_json ParameterJson(const CalibratedParameter& p) {
  return {{"start", p.parameter.start},
          {"value", p.value},
          {"low", p.low},
          {"high", p.high},
          {"min", p.parameter.min},
          {"max", p.parameter.max},
          {"has_effect", p.has_effect},
          {"is_at_bound", p.is_at_bound},
          {"is_identified", p.is_identified}};
}

ordered_json ErrorJson(const sweep::ErrorStructure& e) {
  return {{"motions", e.motions},
          {"horizon_s", NumberOrNull(e.horizon_s)},
          {"ahead_rms_m", NumberOrNull(e.ahead_m)},
          {"ahead_mean_m", NumberOrNull(e.ahead_bias_m)},
          {"left_rms_m", NumberOrNull(e.left_m)},
          {"left_mean_m", NumberOrNull(e.left_bias_m)},
          {"turned_rms_rad", NumberOrNull(e.turned_rad)},
          {"turned_mean_rad", NumberOrNull(e.turned_bias_rad)},
          {"turning_left_mean_rad", NumberOrNull(e.turning_left_rad)},
          {"turning_right_mean_rad", NumberOrNull(e.turning_right_rad)},
          {"lag_s", NumberOrNull(e.lag_s)},
          {"frequency_hz", NumberOrNull(e.frequency_hz)},
          {"frequency_share", NumberOrNull(e.frequency_share)}};
}

ordered_json FitJson(const sweep::Calibration& fit) {
  ordered_json json = {{"loss_before", fit.loss_before},
                       {"loss_after", fit.loss_after},
                       {"steps", fit.steps},
                       {"has_converged", fit.has_converged},
                       {"trials_simulated", fit.trials_simulated}};
  ordered_json& parameters = json["parameters"] = ordered_json::object();
  ordered_json& correlation = json["correlation"] = ordered_json::array();
  for (size_t a = 0; a < fit.parameters.size(); ++a) {
    parameters[fit.parameters[a].parameter.key] = ParameterJson(fit.parameters[a]);
    ordered_json row = ordered_json::array();
    for (size_t b = 0; b < fit.parameters.size(); ++b) {
      row.push_back(NumberOrNull(
          fit.correlation(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(b))));
    }
    correlation.push_back(row);
  }
  return json;
}

std::vector<report::CalibratedTrial> Drawn(const sweep::CalibrationReport& report) {
  std::vector<report::CalibratedTrial> drawn;
  for (const sweep::CalibrationTrial& trial : report.trials) {
    drawn.push_back({trial.level, trial.is_held_out, trial.gap_before_m, trial.gap_after_m});
  }
  return drawn;
}

}  // namespace

std::string FlagOf(const CalibratedParameter& parameter) {
  if (!parameter.has_effect) return "no effect";
  std::string flag = parameter.is_at_bound ? "at a bound" : "";
  if (!parameter.is_identified) flag += flag.empty() ? "not identifiable" : ", not identifiable";
  return flag;
}

std::string CalibrationText(const sweep::CalibrationReport& report) {
  const sweep::Calibration& fit = report.calibration;
  std::string text =
      fmt::format("loss {:.4f} > {:.4f} in {} steps{}, {} trials simulated\n\n", fit.loss_before,
                  fit.loss_after, fit.steps,
                  fit.has_converged ? "" : " (not converged: raise calibrate.method.iterations)",
                  fit.trials_simulated);
  text += ParameterText(fit) + CorrelationText(fit) + '\n' + JudgedText(report.judged) + '\n';
  for (const sweep::CalibrationReport::Errors& errors : report.errors) text += ErrorText(errors);
  return text;
}

std::string CalibrationJson(const experiment::Experiment& experiment,
                            const sweep::CalibrationReport& report) {
  ordered_json json = {{"name", experiment.name},
                       {"confidence", experiment.calibrate.method.confidence},
                       {"fit", FitJson(report.calibration)}};
  for (const sweep::JudgedGroup& group : report.judged) {
    ordered_json& entry = json["judged"][group.level][group.side];
    entry["before"] = LikenessJson(std::vector<sweep::GroupLikeness>{{"x", group.before}})["x"];
    entry["after"] = LikenessJson(std::vector<sweep::GroupLikeness>{{"x", group.after}})["x"];
  }
  for (const sweep::CalibrationReport::Errors& errors : report.errors) {
    json["errors"][errors.side] = {{"before", ErrorJson(errors.before)},
                                   {"after", ErrorJson(errors.after)}};
  }
  for (const sweep::CalibrationTrial& trial : report.trials) {
    json["trials"].push_back({{"log", trial.source},
                              {"level", trial.level},
                              {"trial", trial.trial},
                              {"held_out", trial.is_held_out},
                              {"mean_path_gap_before_m", NumberOrNull(trial.gap_before_m)},
                              {"mean_path_gap_after_m", NumberOrNull(trial.gap_after_m)}});
  }
  json["missing"] = report.missing;
  return Dump(json);
}

void WriteCalibrationFigures(const std::filesystem::path& folder,
                             const experiment::Experiment& experiment,
                             const sweep::CalibrationReport& report) {
  const bool has_gaps = std::any_of(
      report.trials.begin(), report.trials.end(), [](const sweep::CalibrationTrial& trial) {
        return !std::isnan(trial.gap_before_m) && !std::isnan(trial.gap_after_m);
      });
  if (!has_gaps) {
    fmt::print(stderr,
               "note: no figure: no log has a simulated run that reached the end, both "
               "before and after the fit\n");
    return;
  }
  std::vector<report::Figure> parts{report::CalibrationGapFigure(Drawn(report))};
  if (!report.shown_real.poses.empty()) {
    const sweep::CalibrationTrial& shown = report.trials[report.shown];
    parts.push_back(report::CalibrationPathFigure(
        {.name = fmt::format("{}{}trial {}{}", shown.level, shown.level.empty() ? "" : ", ",
                             shown.trial, shown.is_held_out ? " (held out)" : ""),
         .real = report.shown_real,
         .before = report.shown_before,
         .after = report.shown_after}));
  }
  const report::Figure figure =
      report::Stack("calibration", experiment.name + ": before and after the fit", parts);
  for (const auto& [ending, format] : {std::pair{".svg", report::FigureFormat::kSvg},
                                       std::pair{".png", report::FigureFormat::kPng}}) {
    WriteFile((folder / "figures" / (figure.name + ending)), report::Render(figure, format));
  }
}

}  // namespace rift::commands
