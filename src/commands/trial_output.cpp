#include "trial_output.hpp"

#include <fmt/format.h>

namespace rift::commands {
namespace {

using nlohmann::ordered_json;

ordered_json VisitJson(const trial::WaypointVisit& visit) {
  ordered_json json{{"name", visit.name}, {"reached_s", nullptr}, {"closest_m", nullptr}};
  if (visit.reached_s) json["reached_s"] = *visit.reached_s;
  if (visit.closest_m) json["closest_m"] = *visit.closest_m;
  return json;
}

}  // namespace

ordered_json WaypointsJson(const trial::TrialResult& result) {
  ordered_json json = ordered_json::array();
  for (const trial::WaypointVisit& visit : result.visits) json.push_back(VisitJson(visit));
  return json;
}

ordered_json LimitsJson(const trial::LimitCounts& limits) {
  return {{"decisions", limits.decisions},
          {"v_min", limits.v_min},
          {"v_max", limits.v_max},
          {"cruise_cap", limits.cruise_cap},
          {"through_cruise", limits.through_cruise},
          {"w_min", limits.w_min},
          {"w_max", limits.w_max},
          {"normalised", limits.normalised},
          {"slew", limits.slew},
          {"largest_raw_v", limits.largest_raw_v},
          {"largest_raw_w", limits.largest_raw_w}};
}

std::string CommandsCsv(const trial::TrialResult& result) {
  std::string text = "t_s,power_left,power_right\n";
  for (const trial::SentCommand& command : result.commands) {
    text += fmt::format("{},{},{}\n", command.t_s, command.power.left, command.power.right);
  }
  return text;
}

}  // namespace rift::commands
