#include "rift/commands/arguments/inputs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "rift/files/files.hpp"
#include "rift/terminal/print.hpp"

namespace rift::commands {

experiment::Experiment ReadExperiment(const std::filesystem::path& file,
                                      const std::vector<std::string>& overrides) {
  return experiment::LoadExperiment(file.string(), overrides,
                                    [](const std::string& path) { return files::ReadFile(path); });
}

std::string FindInput(const std::string& name) {
  namespace fs = std::filesystem;
  std::error_code not_there;
  if (name.empty() || fs::path(name).is_absolute() || fs::exists(name, not_there)) return name;
  const fs::path program = fs::read_symlink("/proc/self/exe", not_there);
  // PREFIX/bin/rift, or PREFIX/lib/rift/rift-camera.
  for (const fs::path& prefix :
       {program.parent_path().parent_path(), program.parent_path().parent_path().parent_path()}) {
    const fs::path installed = prefix / "share" / "rift" / name;
    if (fs::exists(installed, not_there)) return installed.string();
  }
  return name;
}

void RequireWaypoints(const experiment::Experiment& experiment, const std::string& file) {
  if (!experiment.waypoints.empty() || !experiment.program.segments.empty()) return;
  throw std::invalid_argument(fmt::format(
      "{}: it has no waypoints, as a robot's file alone has none. Name both in a file and give "
      "that: printf 'include: [{}, configs/waypoints/paper.yaml]\\n' > task.yaml",
      file, file));
}

void RequireTask(const experiment::Experiment& experiment, const std::string& file) {
  RequireWaypoints(experiment, file);
  try {
    experiment::TaskOf(experiment);
  } catch (const std::invalid_argument& no_task) {
    throw std::invalid_argument(fmt::format("{}: {}", file, no_task.what()));
  }
}

void WarnOfTilt(const experiment::Experiment& experiment) {
  if (const auto warning = simulation::TiltWarning(experiment.simulation.body)) {
    terminal::Say("warning: " + *warning);
  }
}

namespace {

std::string NameOf(const control::Waypoint& waypoint, size_t index) {
  const std::string name = waypoint.name.empty() ? "" : fmt::format(" ({})", waypoint.name);
  return fmt::format("waypoints[{}]{} at x {:g} m, y {:g} m", index, name, waypoint.x_m,
                     waypoint.y_m);
}

}  // namespace

void RequireReachableWaypoints(const experiment::Experiment& experiment, const std::string& file) {
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

void AddAnyWaypointsFlag(CLI::App& app, bool& any_waypoints) {
  app.add_flag("--any-waypoints", any_waypoints,
               "drive waypoints outside trial.arena, or too far apart to be metres, all the same");
}

vision::TagOptions TagOn(const experiment::Experiment& experiment) {
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

sweep::Inputs FileInputs() {
  return {[](const std::string& path) { return files::ReadIfThere(path); },
          [](const std::string& line) { terminal::Say("note: " + line); }};
}

}  // namespace rift::commands
