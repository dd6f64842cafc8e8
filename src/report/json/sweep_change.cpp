#include "rift/report/json/sweep_change.hpp"

#include <algorithm>

#include "rift/report/json/fields.hpp"

namespace rift::report {
namespace {

using nlohmann::ordered_json;

ordered_json SideJson(const sweep::ChangedSide& side) {
  ordered_json json{{"failures", side.failures},
                    {"told", side.told},
                    {"mean_gap_m", NumberOrNull(side.mean_gap_m)}};
  if (!side.verdict.empty()) json["verdict"] = side.verdict;
  return json;
}

ordered_json SettingJson(const sweep::SettingChange& change) {
  return {{"setting", change.setting},
          {"before", SideJson(change.before)},
          {"after", SideJson(change.after)},
          {"pairs", change.pairs},
          {"gap_change_m", NumberOrNull(change.gap_change_m)},
          {"gap_change_low_m", NumberOrNull(change.gap_change_95_m.low)},
          {"gap_change_high_m", NumberOrNull(change.gap_change_95_m.high)}};
}

}  // namespace

std::string ChangeJson(const sweep::SweepChange& change) {
  ordered_json json{{"before", change.before}, {"after", change.after}};
  json["changed_keys"] = ordered_json::array();
  for (const sweep::ChangedKey& key : change.keys) {
    json["changed_keys"].push_back(
        {{"key", key.key}, {"before", key.before}, {"after", key.after}});
  }
  json["all"] = SettingJson(change.all);
  json["now_hold"] = change.now_hold;
  json["now_fail"] = change.now_fail;
  json["better_share"] = {{"low", change.better_share_95.low},
                          {"high", change.better_share_95.high}};
  json["only_before"] = change.only_before;
  json["only_after"] = change.only_after;
  json["settings"] = ordered_json::array();
  for (const sweep::SettingChange& setting : change.settings) {
    json["settings"].push_back(SettingJson(setting));
  }
  return Dump(json);
}

}  // namespace rift::report
