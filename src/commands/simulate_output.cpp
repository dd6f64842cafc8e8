#include "simulate_output.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "json_fields.hpp"
#include "rift/yaml/enum_name.hpp"
#include "trial_output.hpp"

namespace rift::commands {
using nlohmann::ordered_json;

std::string SimulationJson(const experiment::Experiment& experiment,
                           const sweep::SimulatedRun& run) {
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
  return Dump(json);
}

std::string SimulationText(const experiment::Experiment& experiment,
                           const sweep::SimulatedRun& run) {
  const trial::TrialResult& result = run.result;
  std::string text =
      fmt::format("{}: {}\n", yaml::NameOf(result.outcome), result.reason) +
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
