#include "rift/report/json/json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "rift/report/json/fields.hpp"
#include "rift/sweep/falsify/result.hpp"
#include "rift/yaml/enum_name.hpp"

namespace rift::report {
namespace {

using nlohmann::ordered_json;

ordered_json LevelJson(const sweep::LevelSummary& level) {
  return {{"mean_gap_m", NumberOrNull(level.mean_gap_m)},
          {"failures", level.failures},
          {"n", level.n},
          {"told", level.told},
          {"not_ok", level.not_ok},
          {"sd_gap_m", NumberOrNull(level.sd_gap_m)}};
}

ordered_json LevelsJson(const std::vector<sweep::LevelSummary>& levels) {
  ordered_json json = ordered_json::object();
  for (const sweep::LevelSummary& level : levels) json[level.level] = LevelJson(level);
  return json;
}

ordered_json AnovaJson(const sweep::Anova& of_one) {
  return {{"f", NumberOrNull(of_one.f)},
          {"df", {of_one.df_between, of_one.df_within}},
          {"p", NumberOrNull(of_one.p)},
          {"eta_squared", NumberOrNull(of_one.eta_squared)},
          {"omega_squared", NumberOrNull(of_one.omega_squared)}};
}

ordered_json SettingJson(const sweep::SweepResult& result, const sweep::SettingResult& setting) {
  const gap::RepeatVerdict& verdict = setting.verdict;
  return {{"theta", ThetaJson(result.parameters, setting.theta)},
          {"mean_gap_m", NumberOrNull(setting.mean_gap_m)},
          {"mean_loss_m", NumberOrNull(setting.mean_loss_m)},
          {"loss_low_m", NumberOrNull(setting.loss_m.low)},
          {"loss_high_m", NumberOrNull(setting.loss_m.high)},
          {"verdict", yaml::NameOf(verdict.verdict)},
          {"verdict_text", gap::VerdictText(verdict)},
          {"failures", verdict.above},
          {"n", verdict.repeats},
          {"share_low", verdict.share_low},
          {"share_high", verdict.share_high},
          {"noise_floor_m", NumberOrNull(setting.noise_floor_m)}};
}

ordered_json FalsificationJson(const sweep::SweepResult& result,
                               const sweep::Falsification& found) {
  ordered_json json{{"verdict", yaml::NameOf(found.verdict)},
                    {"strategy", found.strategy},
                    {"evaluations", found.evaluations},
                    {"budget", found.budget},
                    {"ended_by", found.ended},
                    {"first_evaluation", nullptr},
                    {"worst", nullptr}};
  if (found.first_evaluation) json["first_evaluation"] = *found.first_evaluation;
  if (found.worst_setting) {
    json["worst"] = SettingJson(result, result.settings.at(*found.worst_setting));
  }
  return json;
}

/// Of a large sweep only the worst settings: the file is to be read whole.
void AddSettings(const sweep::SweepResult& result, ordered_json& json) {
  constexpr size_t kMostSettings = 10'000;
  std::vector<const sweep::SettingResult*> settings;
  for (const sweep::SettingResult& setting : result.settings) settings.push_back(&setting);
  if (settings.size() > kMostSettings) {
    settings = sweep::WorstSettings(result);
    json["settings_omitted"] = settings.size() - kMostSettings;
    settings.resize(kMostSettings);
  }
  json["settings"] = ordered_json::array();
  for (const sweep::SettingResult* setting : settings) {
    json["settings"].push_back(SettingJson(result, *setting));
  }
}

/// Means over the trials with a gap: what alignment takes away.
ordered_json AttributionJson(const sweep::SweepResult& result) {
  double start_m = 0.0, aligned_m = 0.0, shape_m = 0.0;
  for (const sweep::TrialRow& row : result.rows) {
    if (!row.IsOk()) continue;
    start_m += row.comparison.start_offset_m / result.all.n;
    aligned_m += row.comparison.start_aligned_gap_m / result.all.n;
    shape_m += row.comparison.shape_gap_m / result.all.n;
  }
  return {{"means_over", "trials"},
          {"start_offset_m", start_m},
          {"start_aligned_gap_m", aligned_m},
          {"shape_gap_m", shape_m}};
}

}  // namespace

std::string SummaryJson(const sweep::SweepResult& result) {
  ordered_json json;
  json["name"] = result.name;
  json["rift_version"] = RIFT_VERSION;
  json["candidate"] = result.candidate_kind;
  json["reference"] = result.reference_kind;
  json["definition"] = FieldsToJson(result.gap);
  json["definition"]["tag_offset_m"] = result.tag_offset_m;
  json["definition"]["text"] = gap::DefinitionText(result.gap, result.tag_offset_m);
  json.update(LevelJson(result.all));
  json["verdicts"] = {{"share", result.judged_by.share},
                      {"confidence", result.judged_by.confidence},
                      {"settings_judged_together",
                       std::max(result.judged_settings, static_cast<int>(result.settings.size()))}};
  for (const gap::Verdict verdict : {gap::Verdict::kFalsified, gap::Verdict::kPassed,
                                     gap::Verdict::kNotSeenToFail, gap::Verdict::kUndecided}) {
    json["verdicts"][std::string(yaml::NameOf(verdict))] = result.Count(verdict);
  }
  json["replaced_references"] = ordered_json::array();
  for (const sweep::ReplacedReference& replaced : result.replaced) {
    json["replaced_references"].push_back(
        {{"seed", replaced.seed}, {"used", replaced.used}, {"reason", replaced.reason}});
  }
  json["doubts"] = ordered_json::array();
  for (const sweep::SweepDoubt& doubt : result.doubts) {
    json["doubts"].push_back({{"about", yaml::NameOf(doubt.first.about)},
                              {"trials", doubt.trials},
                              {"row", doubt.row + 1},
                              {"text", doubt.first.text}});
  }
  if (result.all.n > 0) json["attribution"] = AttributionJson(result);
  if (result.falsification) {
    json["falsification"] = FalsificationJson(result, *result.falsification);
  }
  ordered_json by = ordered_json::object(), anova = ordered_json::object();
  for (size_t i = 0; i < result.parameters.size(); ++i) {
    if (!sweep::HasLevels(result.parameters[i])) continue;  // each setting would be its own level
    by[result.parameters[i].Name()] = LevelsJson(sweep::SummariseBy(result, {static_cast<int>(i)}));
  }
  for (const sweep::Anova& of_one : result.anova) anova[of_one.parameter] = AnovaJson(of_one);
  if (!result.parameters.empty()) {
    const sweep::FactorSplit split = sweep::SplitFactors(result.parameters);
    const bool has_range = std::any_of(split.others.begin(), split.others.end(), [&](int i) {
      return !sweep::HasLevels(result.parameters[i]);
    });
    if (split.others.size() > 1 && !has_range) {
      by[split.others_name] = LevelsJson(sweep::SummariseBy(result, split.others));
    }
  }
  json["by"] = std::move(by);
  json["anova"] = std::move(anova);
  AddSettings(result, json);
  return Dump(json);
}

}  // namespace rift::report
