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

ordered_json FactorsJson(const sweep::FactorialAnalysis& factors) {
  ordered_json terms = ordered_json::array();
  for (const sweep::FactorialTerm& term : factors.terms) {
    terms.push_back({{"name", term.name},
                     {"is_interaction", term.IsInteraction()},
                     {"f", NumberOrNull(term.f)},
                     {"df", {term.df, factors.residual_df}},
                     {"p", NumberOrNull(term.p)},
                     {"share", NumberOrNull(term.share)},
                     {"share_low", NumberOrNull(term.share_low)},
                     {"share_high", NumberOrNull(term.share_high)},
                     {"matters", term.p < 0.05}});
  }
  return {{"terms", terms},
          {"trials", factors.n},
          {"residual_sd_m", NumberOrNull(factors.residual_sd_m)},
          {"explained", NumberOrNull(factors.explained)}};
}

ordered_json SobolJson(const sweep::Sensitivity& sensitivity) {
  ordered_json indices = ordered_json::array();
  for (const sweep::SobolIndex& index : sensitivity.indices) {
    indices.push_back({{"parameter", index.parameter},
                       {"first", index.first},
                       {"first_interval", {index.first_low, index.first_high}},
                       {"total", index.total},
                       {"total_interval", {index.total_low, index.total_high}}});
  }
  return {{"indices", indices},
          {"q2", NumberOrNull(sensitivity.q2)},
          {"degree", sensitivity.degree},
          {"trials", sensitivity.trials},
          {"note", sensitivity.note}};
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
  return {{"gap_m", EstimateJson(anatomy.gap_m)},
          {"start_m", EstimateJson(anatomy.start_m)},
          {"start_matters", sweep::IsClear(anatomy.start_m) && anatomy.start_m.mean > 0.0},
          {"frame_m", EstimateJson(anatomy.frame_m)},
          {"shape_m", EstimateJson(anatomy.shape_m)},
          {"pace_m", EstimateJson(anatomy.pace_m)},
          {"timing_m", EstimateJson(anatomy.timing_m)},
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

ordered_json SuggestionsJson(const sweep::SweepResult& result,
                             const std::vector<sweep::Suggestion>& suggestions) {
  ordered_json json = ordered_json::array();
  for (const sweep::Suggestion& suggestion : suggestions) {
    const sweep::SettingResult& setting = result.settings[suggestion.setting];
    json.push_back({{"theta", ThetaJson(result.parameters, setting.theta)},
                    {"repeats", suggestion.repeats},
                    {"rows", RowIds(setting.rows)},
                    {"mean_gap_m", NumberOrNull(suggestion.mean_gap_m)},
                    {"above_now", NumberOrNull(suggestion.above_now)},
                    {"wrong_now", NumberOrNull(suggestion.wrong_now)},
                    {"wrong_after", NumberOrNull(suggestion.wrong_after)},
                    {"flip", NumberOrNull(suggestion.flip)},
                    {"width_now", NumberOrNull(suggestion.width_now)},
                    {"width_after", NumberOrNull(suggestion.width_after)},
                    {"trials_to_decide", suggestion.trials_to_decide < 0
                                             ? ordered_json(nullptr)
                                             : ordered_json(suggestion.trials_to_decide)},
                    {"sentence", suggestion.sentence}});
  }
  return json;
}

}  // namespace

std::string ExplanationJson(const sweep::SweepResult& result,
                            const sweep::Explanation& explanation) {
  ordered_json json{{"name", result.name}, {"rift_version", RIFT_VERSION}};
  json["effects"] = FactorsJson(explanation.factors);
  json["sobol"] = SobolJson(explanation.sensitivity);
  ordered_json& parameters = json["parameters"] = ordered_json::object();
  for (const sweep::Inertness& inert : explanation.inert) {
    parameters[inert.parameter] = InertnessJson(inert);
  }
  json["anatomy"] = AnatomyJson(explanation.anatomy);
  json["failures"] = ClustersJson(explanation.clusters);
  json["failing_region"] = RegionJson(result, explanation.region);
  json["failure_probability"] = ProbabilityJson(explanation.probability);
  json["undecided"] = UndecidedJson(result);
  json["suggestions"] = SuggestionsJson(result, explanation.suggestions);
  return Dump(json);
}

}  // namespace rift::report
