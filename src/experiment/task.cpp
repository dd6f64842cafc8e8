#include "rift/experiment/task.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <vector>

namespace rift::experiment {
namespace {

std::string NameOf(const control::Waypoint& waypoint, size_t index) {
  const std::string name = waypoint.name.empty() ? "" : fmt::format(" ({})", waypoint.name);
  return fmt::format("waypoints[{}]{} at x {:g} m, y {:g} m", index, name, waypoint.x_m,
                     waypoint.y_m);
}

/// Paths that pass a place again may name it again.
std::optional<std::string> TwiceNote(const std::vector<control::Waypoint>& waypoints,
                                     const std::string& file) {
  std::map<std::string_view, size_t> first;
  for (size_t i = 0; i < waypoints.size(); ++i) {
    if (waypoints[i].name.empty()) continue;
    const size_t k = first.try_emplace(waypoints[i].name, i).first->second;
    if (waypoints[k].Position() == waypoints[i].Position()) continue;
    return fmt::format("note: {}: {} has the name of {}: results name both alike", file,
                       NameOf(waypoints[i], i), NameOf(waypoints[k], k));
  }
  return std::nullopt;
}

}  // namespace

void RequireWaypoints(const Experiment& experiment, const std::string& file) {
  if (!experiment.waypoints.empty() || !experiment.program.segments.empty()) return;
  throw std::invalid_argument(fmt::format(
      "{}: it has no waypoints, as a robot's file alone has none. Name both in a file and give "
      "that: printf 'include: [{}, configs/waypoints/paper.yaml]\\n' > task.yaml",
      file, file));
}

void RequireTask(const Experiment& experiment, const std::string& file) {
  RequireWaypoints(experiment, file);
  try {
    TaskOf(experiment);
  } catch (const std::invalid_argument& no_task) {
    throw std::invalid_argument(fmt::format("{}: {}", file, no_task.what()));
  }
}

void RequireReachableWaypoints(const Experiment& experiment, const std::string& file) {
  constexpr double kFar_m = 20.0;           // farther than any floor below one camera
  constexpr double kFastest_m_per_s = 5.0;  // the fastest 3pi+ there is drives 4 m/s
  const std::vector<control::Waypoint>& waypoints = experiment.waypoints;
  double path_m = 0.0, farthest_m = 0.0;
  for (size_t i = 0; i < waypoints.size(); ++i) {
    const control::Waypoint& waypoint = waypoints[i];
    if (!experiment.trial.arena.Contains(waypoint.x_m, waypoint.y_m)) {
      throw std::invalid_argument(fmt::format(
          "{}: {} lies outside trial.arena, where a run ends: move it, widen the arena, "
          "or give --any-waypoints",
          file, NameOf(waypoint, i)));
    }
    if (i > 0) path_m += (waypoint.Position() - waypoints[i - 1].Position()).norm();
    farthest_m = std::max({farthest_m, std::abs(waypoint.x_m), std::abs(waypoint.y_m)});
  }
  const double reach_m = kFastest_m_per_s * experiment.trial.timeout_s;
  if (farthest_m < kFar_m || path_m <= reach_m) return;
  throw std::invalid_argument(fmt::format(
      "{}: its waypoints are {:g} m apart in all, as far as {:g} m out, and no 3pi+ drives that in "
      "trial.timeout_s, {:g} s: waypoints are metres, so divide millimetres by 1000, or give "
      "--any-waypoints",
      file, path_m, farthest_m, experiment.trial.timeout_s));
}

std::vector<std::string> TaskNotes(const Experiment& experiment, const std::string& file) {
  const std::vector<control::Waypoint>& waypoints = experiment.waypoints;
  const double reach_m = experiment.control.reach_radius_m;
  std::optional<std::string> idle, passed, never;
  for (size_t i = 1; i < waypoints.size(); ++i) {
    const control::Waypoint& waypoint = waypoints[i];
    const double leg_m = (waypoint.Position() - waypoints[i - 1].Position()).norm();
    if (waypoint.heading_deg && !idle) {
      idle = fmt::format(
          "note: {}: {} has heading {:g}, and only that of the first waypoint is driven: it does "
          "nothing",
          file, NameOf(waypoint, i), *waypoint.heading_deg);
    }
    if (leg_m < reach_m && !passed) {
      passed = fmt::format(
          "note: {}: {} lies {:g} m from the waypoint before it, within control.reach_radius_m, "
          "{:g} m: it counts as reached without a move",
          file, NameOf(waypoint, i), leg_m, reach_m);
    }
  }
  if (experiment.trial.settle_s >= experiment.trial.timeout_s) {
    never = fmt::format(
        "note: {}: trial.settle_s, {:g} s, is not below trial.timeout_s, {:g} s: the power is zero "
        "until the trial ends",
        file, experiment.trial.settle_s, experiment.trial.timeout_s);
  }
  std::vector<std::string> notes;
  for (const std::optional<std::string>& note : {idle, passed, TwiceNote(waypoints, file), never}) {
    if (note) notes.push_back(*note);
  }
  return notes;
}

std::optional<std::string> FullLineNote(const Experiment& experiment) {
  constexpr double kBitsPerLine = 100.0;  // ten bytes, "0.30 0.30" and its end, by ten bits each
  const double baud = experiment.simulation.link.baud;
  const double period_s = experiment.trial.control_period_s;
  if (baud == 0.0 || period_s * baud >= kBitsPerLine) return std::nullopt;
  return fmt::format(
      "note: trial.control_period_s, {:g} s, sends {:.4g} commands a second, and "
      "simulation.link.baud {:g} takes {:.4g}: they queue up and come later and later; from "
      "{:.4g} s on they do not",
      period_s, 1.0 / period_s, baud, baud / kBitsPerLine, kBitsPerLine / baud);
}

std::optional<std::string> IdleHostNote(const Experiment& experiment) {
  if (experiment.simulation.mocap.host_period_s) return std::nullopt;
  const simulation::TerrainOptions& terrain = experiment.simulation.terrain;
  std::vector<std::string> driven{terrain.surface};
  for (const Parameter& parameter : experiment.space.parameters) {
    if (parameter.key == "simulation.mocap.host_period_s") return std::nullopt;
    if (parameter.key != "simulation.terrain.surface") continue;
    driven.clear();
    for (const ParameterValue& level : parameter.levels) driven.push_back(level.text);
  }
  for (const std::string& name : driven) {
    const auto surface = terrain.surfaces.find(name);
    if (surface == terrain.surfaces.end() || !surface->second.host_period_s) continue;
    return fmt::format(
        "note: simulation.terrain.surfaces.{}.host_period_s is {:g}, and does nothing while "
        "simulation.mocap.host_period_s is none: set that too",
        name, *surface->second.host_period_s);
  }
  return std::nullopt;
}

geometry::Pose2 AxleAtStart(const Experiment& experiment) {
  return TaskOf(experiment).Start() *
         geometry::Pose2{-experiment.simulation.mocap.tag_ahead_m, 0.0, 0.0};
}

vision::TagOptions TagOn(const Experiment& experiment) {
  vision::TagOptions tag = experiment.track.tag;
  const auto& terrain = experiment.simulation.terrain;
  const auto surface = terrain.surfaces.find(terrain.surface);
  if (tag.ground != vision::Ground::kFlat || surface == terrain.surfaces.end()) return tag;
  const simulation::Shape shape = surface->second.shape;
  if (shape == simulation::Shape::kBumps) tag.ground = vision::Ground::kBumps;
  const bool is_sloped = shape != simulation::Shape::kFlat && shape != simulation::Shape::kBumps;
  if (is_sloped) tag.ground = vision::Ground::kFree;
  return tag;
}

}  // namespace rift::experiment
