#include "rift/report/json/fields.hpp"
#include "rift/report/json/json.hpp"
#include "rift/report/text/text.hpp"
#include "rift/sweep/falsify/settings.hpp"
#include "rift/yaml/enum_name.hpp"

namespace rift::report {
namespace {

using nlohmann::ordered_json;

ordered_json TrialJson(const std::string& folder,
                       const std::vector<experiment::Parameter>& parameters,
                       const sweep::ShrunkRow& found, size_t i) {
  const sweep::TrialRow& row = found.rows[i];
  return {{"theta", ThetaJson(parameters, row.theta)},
          {"status", yaml::NameOf(row.status)},
          {"gap_m", NumberOrNull(row.comparison.gap_m)},
          {"falsified", row.falsified},
          {"replay", ReplayCommand(folder, i)}};
}

}  // namespace

std::string ShrunkJson(const sweep::SweepResult& result, const sweep::ShrunkRow& found,
                       const std::string& folder) {
  const std::vector<experiment::Parameter>& parameters = result.parameters;
  const sweep::TrialRow& failing = found.rows.front();
  ordered_json json{{"row", found.id}, {"trial", failing.trial}};
  if (failing.seed) json["seed"] = *failing.seed;
  json["threshold_m"] = result.gap.threshold_m;
  json["nominal"] = ThetaJson(parameters, found.nominal);
  json["failing"] = TrialJson(folder, parameters, found, 0);
  json["shrunk"] = TrialJson(folder, parameters, found, 1);
  json["changes"] = ordered_json::array();
  for (size_t i = 0; i < found.shrunk.changed.size(); ++i) {
    const int parameter = found.shrunk.changed[i];
    json["changes"].push_back({{"parameter", parameters[parameter].Name()},
                               {"nominal", sweep::ValueJson(found.nominal[parameter])},
                               {"failing", sweep::ValueJson(failing.theta[parameter])},
                               {"shrunk", sweep::ValueJson(found.shrunk.theta[parameter])},
                               {"without", TrialJson(folder, parameters, found, 2 + i)}});
  }
  json["is_minimal"] = found.shrunk.is_minimal;
  json["is_fewest"] = found.shrunk.is_fewest;
  json["evaluations"] = found.shrunk.evaluations;
  return Dump(json);
}

std::string RareEventJson(const sweep::RareEvent& event, const sweep::RareEventOptions& options) {
  const ordered_json json{
      {"probability", NumberOrNull(event.probability)},
      {"low", event.low},
      {"high", event.high},
      {"confidence", 0.95},
      {"coefficient_of_variation", NumberOrNull(event.coefficient_of_variation)},
      {"is_reached", event.is_reached},
      {"levels", event.levels},
      {"runs", event.evaluations},
      {"untold", event.untold},
      {"options", FieldsToJson(options)},
      {"sentence", RareEventSentence(event)}};
  return Dump(json);
}

}  // namespace rift::report
