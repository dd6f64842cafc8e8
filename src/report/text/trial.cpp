#include "rift/report/text/text.hpp"

#include <fmt/format.h>

#include "rift/yaml/enum_name.hpp"

namespace rift::report {

std::string SimulationText(const experiment::Experiment& experiment,
                           const sweep::SimulatedRun& run) {
  const trial::TrialResult& result = run.result;
  std::string text =
      fmt::format("{}: {}\n", yaml::NameOf(result.outcome), result.reason) +
      fmt::format("{:.2f} s, {:.3f} m, {} poses logged, seed {}\n", result.Duration_s(),
                  run.truth.ArcLength_m(), result.trajectory.poses.size(), experiment.seed);
  for (size_t i = 0; i < result.visits.size(); ++i) {
    const trial::WaypointVisit& visit = result.visits[i];  // of the waypoint after the start
    const std::string name = visit.name.empty() ? fmt::format("waypoints[{}]", i + 1) : visit.name;
    if (visit.reached_s) text += fmt::format("{} reached at {:.2f} s\n", name, *visit.reached_s);
  }
  const bool has_limits = experiment.program.segments.empty();  // a program keeps to none
  if (has_limits && result.limits.v_max == 0) {
    text += fmt::format("v_max ({:g}) never bound: the largest speed asked for was {:.3f}\n",
                        experiment.control.v_max, result.limits.largest_raw_v);
  }
  return text;
}

}  // namespace rift::report
