#include "rift/report/json/json.hpp"

#include <fmt/format.h>

#include "rift/report/json/fields.hpp"
#include "rift/yaml/enum_name.hpp"

namespace rift::report {
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
  ordered_json json{{"decisions", limits.decisions}};
  trial::LimitCounts::Fields(limits, [&](const char* name, size_t count) { json[name] = count; });
  json["largest_raw_v"] = limits.largest_raw_v;
  json["largest_raw_w"] = limits.largest_raw_w;
  return json;
}

std::string SimulationJson(const experiment::Experiment& experiment,
                           const sweep::SimulatedRun& run) {
  return SimulationJson(experiment, run, SteeringOf(experiment, run));
}

std::string SimulationJson(const experiment::Experiment& experiment, const sweep::SimulatedRun& run,
                           const trial::SteeringCheck& check) {
  const trial::TrialResult& result = run.result;
  ordered_json json{{"name", experiment.name},
                    {"rift_version", RIFT_VERSION},
                    {"seed", experiment.seed},
                    {"outcome", yaml::NameOf(result.outcome)},
                    {"reason", result.reason},
                    {"duration_s", result.Duration_s()},
                    {"path_length_m", result.trajectory.ArcLength_m()},
                    {"true_path_length_m", run.truth.ArcLength_m()},
                    {"poses", result.trajectory.poses.size()},
                    {"poses_refused", result.poses_refused},
                    {"stale_decisions", result.stale_decisions}};
  json["waypoints"] = WaypointsJson(result);
  json["limits"] = LimitsJson(result.limits);
  json["steering"] = SteeringJson(check);
  return Dump(json);
}

std::string CommandsCsv(const trial::TrialResult& result) {
  std::string text = "t_s,power_left,power_right\n";
  for (const trial::SentCommand& command : result.commands) text += CommandsRow(command);
  return text;
}

std::string CommandsRow(const trial::SentCommand& command) {
  return fmt::format("{},{},{}\n", command.t_s, command.power.left, command.power.right);
}

}  // namespace rift::report
