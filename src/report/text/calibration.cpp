#include "rift/report/text/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace rift::report {
namespace {

using sweep::CalibratedParameter;

constexpr double kWorthTelling = 0.7;  // of a correlation, in the text
constexpr double kDegPerRad = 57.29577951308232;

std::string Number(double value, int decimals) {
  return std::isnan(value) ? "-" : fmt::format("{:.{}f}", value, decimals);
}

std::string Change(double before, double after, int decimals) {
  return Number(before, decimals) + " > " + Number(after, decimals);
}

size_t KeyWidth(const sweep::Calibration& fit) {
  size_t width = 9;
  for (const CalibratedParameter& p : fit.parameters)
    width = std::max(width, p.parameter.key.size());
  return width;
}

std::string ParameterText(const sweep::Calibration& fit) {
  const size_t width = KeyWidth(fit);
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

std::string AgreementText(const sweep::CalibrationReport& report) {
  if (report.agreement.empty()) return "";
  std::string text = fmt::format(
      "fits from {} starts; difference: largest distance of two over half the interval's width, at "
      "most {:g} where they agree\n",
      report.agreement.front().values.size(), sweep::StartAgreement::kAgreement);
  const size_t width = KeyWidth(report.calibration);
  for (size_t i = 0; i < report.agreement.size(); ++i) {
    const sweep::StartAgreement& one = report.agreement[i];
    std::string values;
    for (const double value : one.values) values += fmt::format("  {:>9.4g}", value);
    text += fmt::format("{:<{}}{}  difference {:.2f}{}\n",
                        report.calibration.parameters[i].parameter.key, width, values,
                        one.difference, one.agrees ? "" : ", does not agree");
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

}  // namespace

std::string FlagOf(const CalibratedParameter& parameter) {
  if (parameter.is_from_prior) return "from the prior, not the logs";
  if (!parameter.has_effect) return "no effect";
  std::string flag = parameter.is_at_bound ? "at a bound" : "";
  if (!parameter.is_identified) flag += flag.empty() ? "not identifiable" : ", not identifiable";
  return flag;
}

std::string WhyNotWritten(const sweep::Calibration& fit, const std::string& file) {
  if (!fit.IsWorseThanStart()) return "";
  return fmt::format(
      "{}the fit is worse than its start, with a loss of {:.4f} after {:.4f}: raise iterations or "
      "features.rounds of calibrate.method, or set its corrections to 0",
      file.empty() ? "" : file + " is not written: ", fit.loss_after, fit.loss_before);
}

std::string CalibrationText(const sweep::CalibrationReport& report) {
  const sweep::Calibration& fit = report.calibration;
  std::string text = fmt::format(
      "loss {:.4f} > {:.4f} in {} steps{}, {} trials simulated\n\n", fit.loss_before,
      fit.loss_after, fit.steps,
      fit.has_converged
          ? ""
          : " (not converged: raise iterations, or features.rounds, of calibrate.method)",
      fit.trials_simulated);
  text += ParameterText(fit) + CorrelationText(fit) + AgreementText(report) + '\n' +
          JudgedText(report.judged) + '\n';
  for (const sweep::CalibrationReport::Errors& errors : report.errors) text += ErrorText(errors);
  return text;
}

}  // namespace rift::report
