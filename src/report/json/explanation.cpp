#include <algorithm>

#include "rift/report/json/fields.hpp"
#include "rift/report/json/json.hpp"
#include "rift/yaml/enum_name.hpp"

namespace rift::report {
namespace {

using nlohmann::ordered_json;

/// Of many rows the first, which are the most typical ones.
ordered_json RowIds(const std::vector<int>& rows) {
  constexpr size_t kMost = 1000;
  ordered_json ids = ordered_json::array();
  for (size_t i = 0; i < std::min(kMost, rows.size()); ++i) ids.push_back(rows[i] + 1);
  return ids;
}

ordered_json EstimateJson(const sweep::Estimate& estimate) {
  return {{"mean", NumberOrNull(estimate.mean)},
          {"low", NumberOrNull(estimate.low)},
          {"high", NumberOrNull(estimate.high)},
          {"n", estimate.n}};
}

ordered_json EffectsJson(const sweep::Effects& effects) {
  ordered_json parameters = ordered_json::array();
  for (const sweep::ParameterEffect& effect : effects.parameters) {
    parameters.push_back(
        {{"parameter", effect.name},
         {"share", NumberOrNull(effect.share)},
         {"share_interval", {NumberOrNull(effect.share_low), NumberOrNull(effect.share_high)}},
         {"alone", NumberOrNull(effect.alone)},
         {"together_with", effect.together},
         {"df", {effect.df, effects.residual_df}},
         {"p", NumberOrNull(effect.p)},
         {"seen", effect.IsSeen()},
         {"sentence", effect.sentence}});
  }
  return {{"parameters", parameters},
          {"trials", effects.trials},
          {"degree", effects.degree},
          {"explained", NumberOrNull(effects.explained)},
          {"predicted", NumberOrNull(effects.predicted)},
          {"residual_sd_m", NumberOrNull(effects.residual_sd_m)},
          {"note", effects.note}};
}

ordered_json LimitJson(const std::vector<sweep::LimitUse>& uses) {
  ordered_json json = ordered_json::array();
  for (const sweep::LimitUse& use : uses) {
    json.push_back({{"value", use.value},
                    {"runs", use.runs},
                    {"runs_bound", use.runs_bound},
                    {"decisions", use.decisions},
                    {"decisions_bound", use.bound},
                    {"largest_asked_for", use.largest_raw}});
  }
  return json;
}

ordered_json InertnessJson(const sweep::Inertness& inert) {
  ordered_json pairs = ordered_json::array();
  for (const sweep::ValuePair& pair : inert.pairs) {
    pairs.push_back(
        {{"values", {pair.a, pair.b}}, {"compared", pair.compared}, {"identical", pair.identical}});
  }
  return {{"inert", inert.IsInert()},
          {"effect_seen", inert.is_detected},
          {"p", NumberOrNull(inert.p)},
          {"smallest_detectable_m", NumberOrNull(inert.smallest_detectable_m)},
          {"identical_paths", pairs},
          {"candidate_limit", LimitJson(inert.candidate_limit)},
          {"reference_limit", LimitJson(inert.reference_limit)},
          {"why", inert.sentences}};
}

ordered_json AnatomyJson(const sweep::Anatomy& anatomy) {
  ordered_json parts = ordered_json::array();
  for (const sweep::GapPart& part : anatomy.parts) {
    parts.push_back(
        {{"name", part.name}, {"size_m", EstimateJson(part.size_m)}, {"removed_by", part.remedy}});
  }
  return {{"means_over", anatomy.is_over_settings ? "settings" : "trials"},
          {"gap_m", EstimateJson(anatomy.gap_m)},
          {"start_m", EstimateJson(anatomy.start_m)},
          {"start_matters", sweep::IsClear(anatomy.start_m) && anatomy.start_m.mean > 0.0},
          {"frame_m", EstimateJson(anatomy.frame_m)},
          {"shape_m", EstimateJson(anatomy.shape_m)},
          {"pace_m", EstimateJson(anatomy.pace_m)},
          {"timing_m", EstimateJson(anatomy.timing_m)},
          {"goal_m", EstimateJson(anatomy.goal_m)},
          {"only_at_goal", anatomy.only_at_goal},
          {"noise_m", EstimateJson(anatomy.noise_m)},
          {"removable_m", EstimateJson(anatomy.removable_m)},
          {"parts", parts}};
}

ordered_json ClustersJson(const std::vector<sweep::FailureCluster>& clusters) {
  ordered_json json = ordered_json::array();
  for (const sweep::FailureCluster& cluster : clusters) {
    json.push_back({{"trials", cluster.rows.size()},
                    {"typical_row", cluster.rows.front() + 1},
                    {"rows", RowIds(cluster.rows)},
                    {"status", yaml::NameOf(cluster.status)},
                    {"mean_gap_m", NumberOrNull(cluster.mean_gap_m)},
                    {"mean_u", NumberOrNull(cluster.mean_u)},
                    {"sentence", cluster.sentence}});
  }
  return json;
}

ordered_json RegionJson(const sweep::SweepResult& result, const sweep::FailingRegion& region) {
  if (region.cells.empty()) return nullptr;
  ordered_json cells = ordered_json::array();
  for (const sweep::RegionCell& cell : region.cells) {
    cells.push_back({{"x", cell.x},
                     {"y", cell.y},
                     {"share", NumberOrNull(cell.share)},
                     {"trials", cell.trials}});
  }
  return {{"x", result.parameters[region.x_parameter].Name()},
          {"y", result.parameters[region.y_parameter].Name()},
          {"smoothed", region.is_smoothed},
          {"cells", cells}};
}

ordered_json ProbabilityJson(const sweep::FailureProbability& probability) {
  return {{"share", NumberOrNull(probability.share)},
          {"low", probability.low},
          {"high", probability.high},
          {"confidence", probability.confidence},
          {"draws", probability.draws},
          {"failures", probability.failures},
          {"sentence", probability.sentence}};
}

/// Settings whose repeats disagree; of many, the first.
ordered_json UndecidedJson(const sweep::SweepResult& result) {
  constexpr size_t kMost = 1000;
  ordered_json json = ordered_json::array();
  for (const sweep::SettingResult& setting : result.settings) {
    const gap::RepeatVerdict& verdict = setting.verdict;
    const bool is_open = verdict.verdict == gap::Verdict::kUndecided && verdict.repeats > 0;
    if (!is_open || json.size() == kMost) continue;
    json.push_back({{"theta", ThetaJson(result.parameters, setting.theta)},
                    {"rows", RowIds(setting.rows)},
                    {"mean_gap_m", NumberOrNull(setting.mean_gap_m)},
                    {"failures", verdict.above},
                    {"n", verdict.repeats}});
  }
  return json;
}

std::vector<experiment::Parameter> SettableOf(const sweep::SweepResult& result,
                                              const sweep::Suggestions& suggestions) {
  std::vector<experiment::Parameter> parameters;
  for (const int i : suggestions.settable) parameters.push_back(result.parameters[i]);
  return parameters;
}

ordered_json SuggestionsJson(const sweep::SweepResult& result,
                             const sweep::Suggestions& suggestions) {
  const std::vector<experiment::Parameter> parameters = SettableOf(result, suggestions);
  ordered_json json = ordered_json::array();
  for (const sweep::Suggestion& suggestion : suggestions.list) {
    json.push_back({{"set", ThetaJson(parameters, suggestion.values)},
                    {"repeats", suggestion.repeats},
                    {"rows", RowIds(suggestion.rows)},
                    {"failures", suggestion.failures},
                    {"predicted_to_fail", suggestion.is_predicted_to_fail},
                    {"mean_loss_m", NumberOrNull(suggestion.mean_loss_m)},
                    {"fails_now", NumberOrNull(suggestion.fails_now)},
                    {"wrong_now", NumberOrNull(suggestion.wrong_now)},
                    {"wrong_after", NumberOrNull(suggestion.wrong_after)},
                    {"sentence", suggestion.sentence}});
  }
  return {{"experiments", json},
          {"trusted", NumberOrNull(suggestions.trusted)},
          {"note", suggestions.note}};
}

ordered_json RobotJson(const sweep::SweepResult& result, const sweep::Explanation& explanation) {
  const std::vector<experiment::Parameter> parameters = SettableOf(result, explanation.suggestions);
  ordered_json json = ordered_json::array();
  const auto verdicts = sweep::JudgeRobotTrials(explanation.robot, result.judged_by);
  for (std::size_t i = 0; i < verdicts.size(); ++i) {
    const sweep::RobotTrials& driven = explanation.robot[i];
    json.push_back({{"set", ThetaJson(parameters, driven.values)},
                    {"predicted_to_fail", driven.is_predicted_to_fail},
                    {"n", driven.trials},
                    {"failures", driven.failures},
                    {"verdict", yaml::NameOf(verdicts[i].verdict)}});
  }
  return json;
}

}  // namespace

std::string ExplanationJson(const sweep::SweepResult& result,
                            const sweep::Explanation& explanation) {
  ordered_json json{{"name", result.name}, {"rift_version", RIFT_VERSION}};
  json["effects"] = EffectsJson(explanation.effects);
  ordered_json parameters = ordered_json::object();
  for (const sweep::Inertness& inert : explanation.inert) {
    parameters[inert.parameter] = InertnessJson(inert);
  }
  json["parameters"] = std::move(parameters);
  json["anatomy"] = AnatomyJson(explanation.anatomy);
  json["failures"] = ClustersJson(explanation.clusters);
  json["failing_region"] = RegionJson(result, explanation.region);
  json["failure_probability"] = ProbabilityJson(explanation.probability);
  json["undecided"] = UndecidedJson(result);
  json["robot"] = RobotJson(result, explanation);
  json["suggestions"] = SuggestionsJson(result, explanation.suggestions);
  return Dump(json);
}

}  // namespace rift::report
