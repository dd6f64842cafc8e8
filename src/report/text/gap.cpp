#include "rift/report/text/gap.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "rift/report/text/likeness.hpp"
#include "rift/statistics/mean.hpp"
#include "rift/yaml/enum_name.hpp"

namespace rift::report {
namespace {

using gap::Comparison;

/// A column of the table: its head and its cell for one trial.
struct Column {
  const char* head;
  std::string (*cell)(const Comparison&);
};

std::string Metres(double value) { return std::isnan(value) ? "-" : fmt::format("{:.4f}", value); }

const std::vector<Column>& Columns() {
  static const std::vector<Column> columns{
      {"gap_m", [](const Comparison& c) { return Metres(c.gap_m); }},
      {"at_u", [](const Comparison& c) { return fmt::format("{:.3f}", c.gap_u); }},
      {"exact_m", [](const Comparison& c) { return Metres(c.exact_gap_m); }},
      {"mean_m", [](const Comparison& c) { return Metres(c.mean_error_m); }},
      {"rms_m", [](const Comparison& c) { return Metres(c.rms_error_m); }},
      {"median_m", [](const Comparison& c) { return Metres(c.median_error_m); }},
      {"p95_m", [](const Comparison& c) { return Metres(c.p95_error_m); }},
      {"start_m", [](const Comparison& c) { return Metres(c.start_offset_m); }},
      {"end_m", [](const Comparison& c) { return Metres(c.end_error_m); }},
      {"length", [](const Comparison& c) { return fmt::format("{:.3f}", c.length_ratio); }},
      {"hausdorff_m", [](const Comparison& c) { return Metres(c.hausdorff_m); }},
      {"frechet_m", [](const Comparison& c) { return Metres(c.frechet_m); }},
      {"dtw_m", [](const Comparison& c) { return Metres(c.dtw_m); }},
      {"equal_time_m", [](const Comparison& c) { return Metres(c.equal_time_m); }},
  };
  return columns;
}

std::string Table(const gap::GapResult& result) {
  size_t width = 4;
  for (const auto& trial : result.trials) width = std::max(width, trial.path.size());
  std::string text = fmt::format("{:<{}}", "real", width);
  for (const Column& column : Columns()) {
    text += fmt::format("  {:>{}}", column.head, std::max<size_t>(6, std::strlen(column.head)));
  }
  text += '\n';
  for (const auto& trial : result.trials) {
    text += fmt::format("{:<{}}", trial.path, width);
    for (const Column& column : Columns()) {
      text += fmt::format("  {:>{}}", column.cell(trial.comparison),
                          std::max<size_t>(6, std::strlen(column.head)));
    }
    text += '\n';
  }
  return text;
}

template <class Member>
double MeanOf(const gap::GapResult& result, Member member) {
  std::vector<double> values;
  for (const auto& trial : result.trials) values.push_back(trial.comparison.*member);
  return statistics::Mean(values);
}

/// What the gap consists of: what goes with the start offset, what with a rigid motion, and what
/// a simulator would have to explain by its dynamics.
std::string AttributionText(const gap::GapResult& result) {
  return fmt::format(
      "left over: {:.4f} m of it with the starts laid together, {:.4f} m of shape after the best "
      "rigid motion\n",
      MeanOf(result, &Comparison::start_aligned_gap_m), MeanOf(result, &Comparison::shape_gap_m));
}

/// Of the trials that tell their yaw.
std::string YawText(const gap::GapResult& result) {
  double sum_rad = 0.0, largest_rad = 0.0;
  int told = 0;
  for (const auto& [path, comparison] : result.trials) {
    if (std::isnan(comparison.mean_yaw_error_rad)) continue;
    ++told;
    sum_rad += comparison.mean_yaw_error_rad;
    largest_rad = std::max(largest_rad, comparison.max_yaw_error_rad);
  }
  if (told == 0) return "";
  return fmt::format("yaw error: {:.3f} rad in the mean, {:.3f} rad at most\n", sum_rad / told,
                     largest_rad);
}

std::string StandstillText(const gap::GapResult& result) {
  const double share = MeanOf(result, &Comparison::real_standstill_share);
  if (result.options.trim_standstill || share < 0.01) return "";
  return fmt::format(
      "standing still makes {:.1f} % of the real arc length; --trim-standstill takes it out\n",
      100.0 * share);
}

std::string VerdictText(const gap::GapResult& result) {
  const gap::RepeatVerdict& verdict = result.verdict;
  return fmt::format(
      "verdict: {} ({} of {} above {:g} m; at {:g} % confidence {:.0f} to {:.0f} % of such trials "
      "are)\n",
      yaml::NameOf(verdict.verdict), verdict.above, verdict.repeats, result.options.threshold_m,
      100.0 * verdict.confidence, 100.0 * verdict.share_low, 100.0 * verdict.share_high);
}

}  // namespace

std::string GapText(const gap::GapResult& result) {
  std::string text =
      fmt::format("gap: {}\n\n", gap::DefinitionText(result.options, result.tag_offset_m));
  text += Table(result) + '\n';
  text += fmt::format("mean gap: {:.4f} m\n", result.mean_gap_m);
  if (!std::isnan(result.noise_floor_m)) {
    text += fmt::format("noise floor: the real trials are {:.4f} m apart from each other\n",
                        result.noise_floor_m);
  }
  text += AttributionText(result) + YawText(result) + StandstillText(result) + VerdictText(result);
  return result.likeness ? text + LikenessText(*result.likeness) : text;
}

}  // namespace rift::report
