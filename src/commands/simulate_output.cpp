#include "simulate_output.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "enum_name.hpp"
#include "json_fields.hpp"

namespace rift::commands {
namespace {

using nlohmann::ordered_json;

ordered_json VisitJson(const trial::WaypointVisit& visit) {
  ordered_json json{{"name", visit.name}, {"reached_s", nullptr}, {"closest_m", nullptr}};
  if (visit.reached_s) json["reached_s"] = *visit.reached_s;
  if (visit.closest_m) json["closest_m"] = *visit.closest_m;
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

}  // namespace

std::string CommandsCsv(const trial::TrialResult& result) {
  std::string text = "t_s,power_left,power_right\n";
  for (const trial::SentCommand& command : result.commands) {
    text += fmt::format("{},{},{}\n", command.t_s, command.power.left, command.power.right);
  }
  return text;
}

std::string SimulationJson(const config::Experiment& experiment, const sweep::SimulatedRun& run) {
  const trial::TrialResult& result = run.result;
  ordered_json json{{"name", experiment.name},
                    {"rift_version", RIFT_VERSION},
                    {"seed", experiment.seed},
                    {"outcome", NameOf(result.outcome)},
                    {"reason", result.reason},
                    {"duration_s", result.Duration_s()},
                    {"path_length_m", result.trajectory.ArcLength_m()},
                    {"true_path_length_m", run.truth.ArcLength_m()},
                    {"poses", result.trajectory.poses.size()},
                    {"poses_refused", result.poses_refused},
                    {"stale_decisions", result.stale_decisions}};
  json["waypoints"] = ordered_json::array();
  for (const trial::WaypointVisit& visit : result.visits) {
    json["waypoints"].push_back(VisitJson(visit));
  }
  json["limits"] = LimitsJson(result.limits);
  return Dump(json);
}

std::string SimulationText(const config::Experiment& experiment, const sweep::SimulatedRun& run) {
  const trial::TrialResult& result = run.result;
  std::string text =
      fmt::format("{}: {}\n", NameOf(result.outcome), result.reason) +
      fmt::format("{:.2f} s, {:.3f} m, {} poses logged, seed {}\n", result.Duration_s(),
                  run.truth.ArcLength_m(), result.trajectory.poses.size(), experiment.seed);
  for (const trial::WaypointVisit& visit : result.visits) {
    if (visit.reached_s)
      text += fmt::format("{} reached at {:.2f} s\n", visit.name, *visit.reached_s);
  }
  if (result.limits.v_max == 0) {
    text += fmt::format("v_max ({:g}) never bound: the largest speed asked for was {:.3f}\n",
                        experiment.control.v_max, result.limits.largest_raw_v);
  }
  return text;
}

}  // namespace rift::commands
