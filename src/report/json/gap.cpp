#include "rift/report/json/json.hpp"

#include <fmt/format.h>

#include <cmath>

#include "rift/report/json/fields.hpp"
#include "rift/yaml/enum_name.hpp"

namespace rift::report {

namespace {

using nlohmann::ordered_json;

/// The motion after which the shape gap is left.
ordered_json MotionJson(const gap::GapResult& result, size_t trial) {
  if (!result.options.IsInSpace()) {
    const geometry::Pose2& motion = result.trials[trial].comparison.real_from_sim;
    return {{"x_m", motion.x_m}, {"y_m", motion.y_m}, {"yaw_rad", motion.yaw_rad}};
  }
  const geometry::Pose3 motion =
      gap::BestMotionInSpace(result.sim, result.reals[trial], result.options);
  return {{"x_m", motion.x_m}, {"y_m", motion.y_m}, {"z_m", motion.z_m}, {"qx", motion.qx},
          {"qy", motion.qy},   {"qz", motion.qz},   {"qw", motion.qw}};
}

ordered_json ComparisonJson(const gap::Comparison& c, ordered_json motion) {
  return {{"gap_m", NumberOrNull(c.gap_m)},
          {"u", NumberOrNull(c.gap_u)},
          {"exact_gap_m", NumberOrNull(c.exact_gap_m)},
          {"exact_u", NumberOrNull(c.exact_gap_u)},
          {"mean_error_m", NumberOrNull(c.mean_error_m)},
          {"rms_error_m", NumberOrNull(c.rms_error_m)},
          {"median_error_m", NumberOrNull(c.median_error_m)},
          {"p95_error_m", NumberOrNull(c.p95_error_m)},
          {"mean_yaw_error_rad", NumberOrNull(c.mean_yaw_error_rad)},
          {"max_yaw_error_rad", NumberOrNull(c.max_yaw_error_rad)},
          {"start_offset_m", NumberOrNull(c.start_offset_m)},
          {"start_aligned_gap_m", NumberOrNull(c.start_aligned_gap_m)},
          {"shape_gap_m", NumberOrNull(c.shape_gap_m)},
          {"real_from_sim", std::move(motion)},
          {"sim_length_m", NumberOrNull(c.sim_length_m)},
          {"real_length_m", NumberOrNull(c.real_length_m)},
          {"length_ratio", NumberOrNull(c.length_ratio)},
          {"end_error_m", NumberOrNull(c.end_error_m)},
          {"sim_standstill_share", NumberOrNull(c.sim_standstill_share)},
          {"real_standstill_share", NumberOrNull(c.real_standstill_share)},
          {"hausdorff_m", NumberOrNull(c.hausdorff_m)},
          {"frechet_m", NumberOrNull(c.frechet_m)},
          {"dtw_m", NumberOrNull(c.dtw_m)},
          {"equal_time_m", NumberOrNull(c.equal_time_m)}};
}

}  // namespace

std::string GapJson(const gap::GapResult& result) {
  const gap::RepeatVerdict& verdict = result.verdict;
  ordered_json json;
  json["definition"] = FieldsToJson(result.options);
  json["definition"]["tag_offset_m"] = result.tag_offset_m;
  json["definition"]["text"] = gap::DefinitionText(result.options, result.tag_offset_m);
  json["trials"] = ordered_json::array();
  for (size_t i = 0; i < result.trials.size(); ++i) {
    const gap::GapResult::Trial& trial = result.trials[i];
    ordered_json row{{"sim", result.sim_path}, {"real", trial.path}};
    row.update(ComparisonJson(trial.comparison, MotionJson(result, i)));
    row["falsified"] = trial.comparison.gap_m > result.options.threshold_m;
    json["trials"].push_back(std::move(row));
  }
  json["mean_gap_m"] = result.mean_gap_m;
  json["noise_floor_m"] = NumberOrNull(result.noise_floor_m);
  json["verdict"] = yaml::NameOf(verdict.verdict);
  json["verdict_text"] = gap::VerdictText(verdict);
  json["repeats"] = {{"n", verdict.repeats},
                     {"above_threshold", verdict.above},
                     {"share", result.judged_by.share},
                     {"confidence", verdict.confidence},
                     {"share_low", verdict.share_low},
                     {"share_high", verdict.share_high}};
  if (result.likeness) json["likeness"] = LikenessJson(*result.likeness);
  return Dump(json);
}

std::string ProfileCsv(const gap::GapResult& result) {
  const bool in_space = result.options.IsInSpace();
  std::string text = "real,u,error_m,yaw_error_rad,sim_x_m,sim_y_m,real_x_m,real_y_m";
  text += in_space ? ",sim_z_m,real_z_m\n" : "\n";
  for (size_t i = 0; i < result.reals.size(); ++i) {
    const gap::ErrorProfile profile =
        gap::ProfileAlong(result.sim, result.reals[i], result.options);
    for (size_t k = 0; k < profile.u.size(); ++k) {
      const double yaw_rad = profile.yaw_error_rad[k];
      text +=
          fmt::format("{},{},{},{},{},{},{},{}", i + 1, profile.u[k], profile.error_m[k],
                      std::isnan(yaw_rad) ? "" : fmt::format("{}", yaw_rad), profile.sim_m[k].x(),
                      profile.sim_m[k].y(), profile.real_m[k].x(), profile.real_m[k].y());
      if (in_space) text += fmt::format(",{},{}", profile.sim_z_m[k], profile.real_z_m[k]);
      text += '\n';
    }
  }
  return text;
}

namespace {

using gap::BothSides;
using nlohmann::ordered_json;

ordered_json BothJson(const BothSides& both) {
  return {{"sim", NumberOrNull(both.sim)},
          {"real", NumberOrNull(both.real)},
          {"ratio", NumberOrNull(both.Ratio())}};
}

/// With the interval of the ratio over settings.
ordered_json RatioJson(const BothSides& both) {
  ordered_json json = BothJson(both);
  json["low"] = NumberOrNull(both.ratio_interval.low);
  json["high"] = NumberOrNull(both.ratio_interval.high);
  return json;
}

}  // namespace

ordered_json LikenessJson(const gap::Likeness& likeness) {
  return {{"sims", likeness.sims},
          {"reals", likeness.reals},
          {"spread_m", RatioJson(likeness.spread_m)},
          {"weave_m", RatioJson(likeness.weave_m)},
          {"wavelength_m", BothJson(likeness.wavelength_m)},
          {"speed_mps", RatioJson(likeness.speed_mps)},
          {"mean_gap_m", NumberOrNull(likeness.mean_gap_m)},
          {"mean_path_gap_m", NumberOrNull(likeness.mean_path_gap_m)},
          {"energy_m", NumberOrNull(likeness.energy_m)},
          {"energy_p", NumberOrNull(likeness.energy_p)},
          {"inside_share", NumberOrNull(likeness.inside_share)},
          {"inside_expected", NumberOrNull(likeness.inside_expected)}};
}

namespace {

ordered_json TestJson(const statistics::TwoSampleTest& test) {
  return {{"accuracy", NumberOrNull(test.accuracy)},
          {"low", NumberOrNull(test.accuracy_interval.low)},
          {"high", NumberOrNull(test.accuracy_interval.high)},
          {"p", NumberOrNull(test.p)}};
}

/// The one that tells most first.
ordered_json FeaturesJson(const sweep::Distinction& told) {
  ordered_json json = ordered_json::array();
  for (const statistics::FeatureEvidence& evidence : told.all.features) {
    const sweep::DriveFeature& feature = sweep::DriveFeatures()[evidence.feature];
    const sweep::FeatureSummary& summary = told.features[evidence.feature];
    json.push_back({{"name", feature.name},
                    {"is_timing", feature.is_timing},
                    {"accuracy", NumberOrNull(evidence.accuracy)},
                    {"low", NumberOrNull(evidence.accuracy_interval.low)},
                    {"high", NumberOrNull(evidence.accuracy_interval.high)},
                    {"weight", NumberOrNull(evidence.weight)},
                    {"mean_sim", NumberOrNull(summary.mean.sim)},
                    {"mean_real", NumberOrNull(summary.mean.real)},
                    {"sd_sim", NumberOrNull(summary.sd.sim)},
                    {"sd_real", NumberOrNull(summary.sd.real)}});
  }
  return json;
}

ordered_json ClassifierJson(const sweep::Distinction& told) {
  ordered_json json = TestJson(told.all);
  json["without_timing"] = TestJson(told.without_timing);
  json["reals"] = told.all.first;
  json["sims"] = told.all.second;
  json["settings"] = told.all.groups;
  json["features"] = FeaturesJson(told);
  return json;
}

ordered_json PredictionJson(const sweep::PathPrediction& prediction) {
  return {{"reals", prediction.reals},
          {"simulated_m", NumberOrNull(prediction.simulated_m)},
          {"other_real_m", NumberOrNull(prediction.other_real_m)},
          {"difference_m", NumberOrNull(prediction.difference_m)},
          {"low_m", NumberOrNull(prediction.difference_interval_m.low)},
          {"high_m", NumberOrNull(prediction.difference_interval_m.high)}};
}

ordered_json RanksJson(const sweep::RankAgreement& ranks) {
  const auto entry = [](double value, const statistics::Interval& interval) {
    return ordered_json{{"correlation", NumberOrNull(value)},
                        {"low", NumberOrNull(interval.low)},
                        {"high", NumberOrNull(interval.high)}};
  };
  return {{"settings", ranks.settings},
          {"simulated", entry(ranks.simulated, ranks.simulated_interval)},
          {"real", entry(ranks.real, ranks.real_interval)}};
}

}  // namespace

ordered_json LikenessJson(const sweep::DriveLikeness& likeness) {
  ordered_json json = LikenessJson(likeness.path);
  json["loop_delay_s"] = BothJson(likeness.loop_delay_s);
  json["loop_r2"] = BothJson(likeness.loop_r2);
  json["steering_gain_rad_s"] = BothJson(likeness.steering_gain_rad_s);
  json["runs"] = likeness.runs;
  json["failed_runs"] = likeness.failed_runs;
  json["circled_runs"] = likeness.circled_runs;
  json["prediction"] = PredictionJson(likeness.prediction);
  json["ranks"] = RanksJson(likeness.ranks);
  json["classifier"] = ClassifierJson(likeness.told_apart);
  return json;
}

ordered_json LikenessJson(const std::vector<sweep::GroupLikeness>& groups) {
  ordered_json json = ordered_json::object();
  for (const auto& [level, likeness] : groups) json[level] = LikenessJson(likeness);
  return json;
}

}  // namespace rift::report
