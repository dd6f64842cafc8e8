#include "rift/report/text/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "rift/statistics/descriptive.hpp"
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

/// What becomes of the gap without the start offset, which may have made it smaller, and without
/// any rigid motion: what a simulator would have to explain by its dynamics.
std::string AttributionText(const gap::GapResult& result) {
  return fmt::format(
      "with the starts laid together the gap is {:.4f} m; after the best rigid motion {:.4f} m of "
      "shape are left\n",
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

/// Of a robot that drives off and arrives without standing the first and the last way within the
/// radius is logged as standing too.
std::string StandstillOf(const gap::GapResult& result, const char* side,
                         double Comparison::*share_of, double Comparison::*length_of_m) {
  const double share = MeanOf(result, share_of);
  const double standing_m = share * MeanOf(result, length_of_m);
  const bool may_have_moved = standing_m <= 2.0 * result.options.standstill_radius_m;
  if (!(share >= 0.01) || may_have_moved) return "";
  const std::string what_to_do = share < 1.0
                                     ? "--trim-standstill takes it out"
                                     : fmt::format("it never leaves --standstill-radius, {:g} m",
                                                   result.options.standstill_radius_m);
  return fmt::format("standing still makes {:.1f} % of the {} arc length; {}\n", 100.0 * share,
                     side, what_to_do);
}

std::string StandstillText(const gap::GapResult& result) {
  if (result.options.trim_standstill) return "";
  return StandstillOf(result, "simulated", &Comparison::sim_standstill_share,
                      &Comparison::sim_length_m) +
         StandstillOf(result, "real", &Comparison::real_standstill_share,
                      &Comparison::real_length_m);
}

std::string VerdictText(const gap::GapResult& result) {
  const gap::RepeatVerdict& verdict = result.verdict;
  return fmt::format(
      "verdict: {}: {} of {} above {:g} m; the share of such runs is above {:.0f} % and below "
      "{:.0f} %, each with {:g} % confidence; falsified: above {:g} %\n",
      gap::VerdictText(verdict), verdict.above, verdict.repeats, result.options.threshold_m,
      100.0 * verdict.share_low, 100.0 * verdict.share_high, 100.0 * verdict.confidence,
      100.0 * result.judged_by.share);
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

namespace {

using gap::BothSides;

std::string Number(double value, int decimals) {
  return std::isnan(value) ? "-" : fmt::format("{:.{}f}", value, decimals);
}

std::string Millimetres(const BothSides& both) {
  return fmt::format("{}/{} {}", Number(1e3 * both.sim, 1), Number(1e3 * both.real, 1),
                     Number(both.Ratio(), 2));
}

std::string Seconds(const BothSides& both) {
  return fmt::format("{}/{}", Number(both.sim, 3), Number(both.real, 3));
}

/// "spread: 28.1 mm, of the robot 39.0 mm (ratio 0.72)"; nothing when one side has none.
std::string Sentence(const char* name, const BothSides& both, double scale, const char* unit) {
  if (std::isnan(both.Ratio())) return "";
  return fmt::format("{}: {:.1f} {}, the robot's {:.1f} {} (ratio {:.2f})\n", name,
                     scale * both.sim, unit, scale * both.real, unit, both.Ratio());
}

/// "0.961 [0.93, 0.98]"
std::string WithInterval(double value, const statistics::Interval& interval, int decimals = 3) {
  if (std::isnan(interval.low)) return Number(value, decimals);
  return fmt::format("{} [{}, {}]", Number(value, decimals), Number(interval.low, 2),
                     Number(interval.high, 2));
}

/// "32.4 - 39.1 [-9.0, 2.1]" in millimetres: simulated, other real, interval of the difference.
std::string PredictionText(const sweep::PathPrediction& prediction) {
  const statistics::Interval& interval = prediction.difference_interval_m;
  return fmt::format("{} - {} [{}, {}]", Number(1e3 * prediction.simulated_m, 1),
                     Number(1e3 * prediction.other_real_m, 1), Number(1e3 * interval.low, 1),
                     Number(1e3 * interval.high, 1));
}

std::string IntervalsText(const std::vector<sweep::GroupLikeness>& groups, size_t width) {
  std::string text = fmt::format(
      "with intervals over settings; path_mm: gap of the mean simulated path to a real one - gap "
      "of the other real trials to it; rank: correlation of the gap to the task over settings; "
      "failed: runs that did not arrive, or circled before they did\n"
      "{:<{}}  {:>18}  {:>18}  {:>18}  {:>26}  {:>20}  {:>20}  {:>10}\n",
      "", width, "spread", "weave", "speed", "path_mm", "rank simulated", "rank real", "failed");
  for (const auto& [level, likeness] : groups) {
    const gap::Likeness& path = likeness.path;
    const sweep::RankAgreement& ranks = likeness.ranks;
    text += fmt::format("{:<{}}  {:>18}  {:>18}  {:>18}  {:>26}  {:>20}  {:>20}  {:>10}\n", level,
                        width, WithInterval(path.spread_m.Ratio(), path.spread_m.ratio_interval, 2),
                        WithInterval(path.weave_m.Ratio(), path.weave_m.ratio_interval, 2),
                        WithInterval(path.speed_mps.Ratio(), path.speed_mps.ratio_interval, 2),
                        PredictionText(likeness.prediction),
                        WithInterval(ranks.simulated, ranks.simulated_interval, 2),
                        WithInterval(ranks.real, ranks.real_interval, 2),
                        fmt::format("{}/{}", likeness.failed_runs, likeness.runs));
  }
  return text;
}

std::string ClassifierText(const std::vector<sweep::GroupLikeness>& groups, size_t width) {
  std::string text = fmt::format(
      "classifier: share of simulated and real logs, each half, that are told right in settings "
      "it has not seen; 0.5: it cannot tell\n{:<{}}  {:>20}  {:>6}  {:>20}  {:>6}  {}\n",
      "", width, "all features", "p", "without timing", "p", "settings");
  for (const auto& [level, likeness] : groups) {
    const statistics::TwoSampleTest &all = likeness.told_apart.all,
                                    &without = likeness.told_apart.without_timing;
    text += fmt::format("{:<{}}  {:>20}  {:>6}  {:>20}  {:>6}  {:>8}\n", level, width,
                        WithInterval(all.accuracy, all.accuracy_interval), Number(all.p, 3),
                        WithInterval(without.accuracy, without.accuracy_interval),
                        Number(without.p, 3), all.groups);
  }
  return text;
}

/// Of all trials together: each feature whose interval leaves out guessing.
std::string FeaturesText(const sweep::Distinction& told) {
  std::string text = fmt::format(
      "what gives the simulator away (a classifier of this feature alone):\n"
      "{:<28}  {:>20}  {:>20}  {:>20}\n",
      "", "accuracy", "simulated (sd)", "real (sd)");
  const auto side = [](double mean, double sd) { return fmt::format("{:.3g} ({:.2g})", mean, sd); };
  int shown = 0;
  for (const statistics::FeatureEvidence& evidence : told.all.features) {
    if (!(evidence.accuracy_interval.low > 0.5)) continue;
    ++shown;
    const sweep::FeatureSummary& summary = told.features[evidence.feature];
    text += fmt::format(
        "{:<28}  {:>20}  {:>20}  {:>20}\n", sweep::DriveFeatures()[evidence.feature].name,
        WithInterval(evidence.accuracy, evidence.accuracy_interval),
        side(summary.mean.sim, summary.sd.sim), side(summary.mean.real, summary.sd.real));
  }
  return shown > 0 ? text : "";
}

}  // namespace

std::string LikenessText(const std::vector<sweep::GroupLikeness>& groups) {
  size_t width = 8;
  for (const sweep::GroupLikeness& group : groups) width = std::max(width, group.level.size());
  std::string text = fmt::format(
      "likeness: simulated / real; a simulator that is like the robot has all ratios at 1\n"
      "{:<{}}  {:>17}  {:>17}  {:>11}  {:>11}  {:>15}  {:>8}  {:>6}\n",
      "", width, "spread_mm", "weave_mm", "delay_s", "speed_ratio", "wavelength_mm", "energy_p",
      "inside");
  for (const auto& [level, likeness] : groups) {
    const gap::Likeness& path = likeness.path;
    text += fmt::format("{:<{}}  {:>17}  {:>17}  {:>11}  {:>11}  {:>15}  {:>8}  {:>6}\n", level,
                        width, Millimetres(path.spread_m), Millimetres(path.weave_m),
                        Seconds(likeness.loop_delay_s), Number(path.speed_mps.Ratio(), 3),
                        fmt::format("{}/{}", Number(1e3 * path.wavelength_m.sim, 0),
                                    Number(1e3 * path.wavelength_m.real, 0)),
                        Number(path.energy_p, 3), Number(path.inside_share, 2));
  }
  text += '\n' + IntervalsText(groups, width) + '\n' + ClassifierText(groups, width);
  return groups.empty() ? text : text + FeaturesText(groups.back().likeness.told_apart);
}

std::string LikenessText(const gap::Likeness& likeness) {
  std::string text =
      fmt::format("likeness of {} simulated and {} real paths:\n", likeness.sims, likeness.reals);
  text += Sentence("  spread of the repeats", likeness.spread_m, 1e3, "mm");
  text += Sentence("  weave", likeness.weave_m, 1e3, "mm");
  text += Sentence("  wavelength of the weave", likeness.wavelength_m, 1e3, "mm");
  text += Sentence("  speed", likeness.speed_mps, 1e3, "mm/s");
  text += fmt::format("  mean simulated path: {:.4f} m from a real one in the mean\n",
                      likeness.mean_path_gap_m);
  if (!std::isnan(likeness.energy_p)) {
    text +=
        fmt::format("  two-sample test: p = {:.3f} that one robot drove both\n", likeness.energy_p);
  }
  if (!std::isnan(likeness.inside_share)) {
    text += fmt::format(
        "  inside the simulated band: {:.0f} % of the real paths ({:.0f} % expected of a perfect "
        "simulator)\n",
        100.0 * likeness.inside_share, 100.0 * likeness.inside_expected);
  }
  return text;
}

}  // namespace rift::report
