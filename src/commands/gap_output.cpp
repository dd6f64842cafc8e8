#include "gap_output.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>

#include "json_fields.hpp"
#include "likeness_output.hpp"
#include "rift/yaml/enum_name.hpp"

namespace rift::commands {
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

std::string Table(const GapEvidence& evidence) {
  size_t width = 4;
  for (const auto& trial : evidence.trials) width = std::max(width, trial.path.size());
  std::string text = fmt::format("{:<{}}", "real", width);
  for (const Column& column : Columns()) {
    text += fmt::format("  {:>{}}", column.head, std::max<size_t>(6, std::strlen(column.head)));
  }
  text += '\n';
  for (const auto& trial : evidence.trials) {
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
double MeanOf(const GapEvidence& evidence, Member member) {
  double sum = 0.0;
  for (const auto& trial : evidence.trials) sum += trial.comparison.*member;
  return sum / static_cast<double>(evidence.trials.size());
}

/// What the gap consists of: what goes with the start offset, what with a rigid motion, and what
/// a simulator would have to explain by its dynamics.
std::string AttributionText(const GapEvidence& evidence) {
  return fmt::format(
      "left over: {:.4f} m of it with the starts laid together, {:.4f} m of shape after the best "
      "rigid motion\n",
      MeanOf(evidence, &Comparison::start_aligned_gap_m),
      MeanOf(evidence, &Comparison::shape_gap_m));
}

/// Of the trials that tell their yaw.
std::string YawText(const GapEvidence& evidence) {
  double sum_rad = 0.0, largest_rad = 0.0;
  int told = 0;
  for (const auto& [path, comparison] : evidence.trials) {
    if (std::isnan(comparison.mean_yaw_error_rad)) continue;
    ++told;
    sum_rad += comparison.mean_yaw_error_rad;
    largest_rad = std::max(largest_rad, comparison.max_yaw_error_rad);
  }
  if (told == 0) return "";
  return fmt::format("yaw error: {:.3f} rad in the mean, {:.3f} rad at most\n", sum_rad / told,
                     largest_rad);
}

std::string StandstillText(const GapEvidence& evidence) {
  const double share = MeanOf(evidence, &Comparison::real_standstill_share);
  if (evidence.options.trim_standstill || share < 0.01) return "";
  return fmt::format(
      "standing still makes {:.1f} % of the real arc length; --trim-standstill takes it out\n",
      100.0 * share);
}

std::string VerdictText(const GapEvidence& evidence) {
  const gap::RepeatVerdict& verdict = evidence.verdict;
  return fmt::format(
      "verdict: {} ({} of {} above {:g} m; at {:g} % confidence {:.0f} to {:.0f} % of such trials "
      "are)\n",
      yaml::NameOf(verdict.verdict), verdict.above, verdict.repeats, evidence.options.threshold_m,
      100.0 * verdict.confidence, 100.0 * verdict.share_low, 100.0 * verdict.share_high);
}

}  // namespace

void Judge(GapEvidence& evidence) {
  std::vector<double> gaps_m;
  for (const auto& trial : evidence.trials) gaps_m.push_back(trial.comparison.gap_m);
  evidence.mean_gap_m = MeanOf(evidence, &Comparison::gap_m);
  evidence.noise_floor_m = gap::NoiseFloor_m(evidence.reals, evidence.options);
  evidence.verdict = gap::JudgeRepeats(gaps_m, evidence.options.threshold_m);
}

std::string GapText(const GapEvidence& evidence) {
  std::string text =
      fmt::format("gap: {}\n\n", gap::DefinitionText(evidence.options, evidence.tag_offset_m));
  text += Table(evidence) + '\n';
  text += fmt::format("mean gap: {:.4f} m\n", evidence.mean_gap_m);
  if (!std::isnan(evidence.noise_floor_m)) {
    text += fmt::format("noise floor: the real trials are {:.4f} m apart from each other\n",
                        evidence.noise_floor_m);
  }
  text += AttributionText(evidence) + YawText(evidence) + StandstillText(evidence) +
          VerdictText(evidence);
  return evidence.likeness ? text + LikenessText(*evidence.likeness) : text;
}

std::string GapJson(const GapEvidence& evidence) {
  const gap::RepeatVerdict& verdict = evidence.verdict;
  nlohmann::ordered_json json;
  json["definition"] = FieldsToJson(evidence.options);
  json["definition"]["tag_offset_m"] = evidence.tag_offset_m;
  json["definition"]["text"] = gap::DefinitionText(evidence.options, evidence.tag_offset_m);
  json["trials"] = nlohmann::ordered_json::array();
  for (const auto& trial : evidence.trials) {
    nlohmann::ordered_json row{{"sim", evidence.sim_path}, {"real", trial.path}};
    row.update(ComparisonToJson(trial.comparison));
    row["falsified"] = trial.comparison.gap_m > evidence.options.threshold_m;
    json["trials"].push_back(std::move(row));
  }
  json["mean_gap_m"] = evidence.mean_gap_m;
  json["noise_floor_m"] = NumberOrNull(evidence.noise_floor_m);
  json["verdict"] = yaml::NameOf(verdict.verdict);
  json["repeats"] = {{"n", verdict.repeats},
                     {"above_threshold", verdict.above},
                     {"confidence", verdict.confidence},
                     {"share_above_low", verdict.share_low},
                     {"share_above_high", verdict.share_high}};
  if (evidence.likeness) json["likeness"] = LikenessJson(*evidence.likeness);
  return Dump(json);
}

std::string ProfileCsv(const GapEvidence& evidence) {
  std::string text = "real,u,error_m,yaw_error_rad,sim_x_m,sim_y_m,real_x_m,real_y_m\n";
  for (size_t i = 0; i < evidence.reals.size(); ++i) {
    const gap::ErrorProfile profile =
        gap::ProfileAlong(evidence.sim, evidence.reals[i], evidence.options);
    for (size_t k = 0; k < profile.u.size(); ++k) {
      const double yaw_rad = profile.yaw_error_rad[k];
      text +=
          fmt::format("{},{},{},{},{},{},{},{}\n", i + 1, profile.u[k], profile.error_m[k],
                      std::isnan(yaw_rad) ? "" : fmt::format("{}", yaw_rad), profile.sim_m[k].x(),
                      profile.sim_m[k].y(), profile.real_m[k].x(), profile.real_m[k].y());
    }
  }
  return text;
}

}  // namespace rift::commands
