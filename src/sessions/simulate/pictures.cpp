#include "rift/sessions/simulate/pictures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "rift/report/figures/figures.hpp"

namespace rift::sessions {
namespace {

constexpr double kGroundStep_m = 0.002;  // the edge of a bump shows

/// The ground under the robot's path, from end to end.
std::vector<Eigen::Vector2d> GroundProfile(const simulation::Terrain& terrain,
                                           const trajectory::Trajectory& truth) {
  const auto by_x = [](const auto& a, const auto& b) { return a.x_m < b.x_m; };
  const auto [left, right] = std::minmax_element(truth.poses.begin(), truth.poses.end(), by_x);
  std::vector<Eigen::Vector2d> profile;
  for (double x_m = left->x_m - 0.1; x_m <= right->x_m + 0.1; x_m += kGroundStep_m) {
    const double z_m = terrain.HeightAt(x_m, left->y_m);
    if (std::isfinite(z_m)) profile.emplace_back(x_m, z_m);
  }
  return profile;
}

/// Rectangles of the floor with their own friction.
std::vector<geometry::FloorArea> AreasOf(const simulation::TerrainOptions& terrain) {
  std::vector<geometry::FloorArea> areas;
  for (const simulation::PatchOptions& patch : terrain.patches) {
    areas.push_back({fmt::format("mu {:g}", patch.mu), patch.x_min_m, patch.x_max_m, patch.y_min_m,
                     patch.y_max_m});
  }
  return areas;
}

}  // namespace

report::Figure FigureOf(const Simulated& made) {
  const auto& [experiment, trial, run] = made;
  const simulation::Terrain terrain(trial.simulation.terrain, trial.image);
  report::SimulatedTrial drawn{.name = experiment.name,
                               .truth = run.truth,
                               .logged = run.result.trajectory,
                               .areas = AreasOf(trial.simulation.terrain),
                               .ground_xz_m = GroundProfile(terrain, run.truth)};
  for (const control::Waypoint& waypoint : trial.task.waypoints) {
    drawn.waypoints.push_back({waypoint.name, waypoint.Position()});
  }
  return report::SimulationFigure(drawn);
}

view::Film FilmOf(const Simulated& made) {
  const auto& [experiment, trial, run] = made;
  const simulation::Terrain terrain(trial.simulation.terrain, trial.image);
  view::Run shown{
      .title = fmt::format("{} on {}", experiment.name, trial.simulation.terrain.surface),
      .body = view::ShapeOf(trial.simulation.body),
      .height_at = [&](double x_m, double y_m) { return terrain.HeightAt(x_m, y_m); },
      .truth = run.truth,
      .logged = run.result.trajectory,
      .outcome = run.result.reason};
  view::ShowTask(shown, trial.task);
  shown.patches = AreasOf(trial.simulation.terrain);
  return view::MakeFilm(shown);
}

}  // namespace rift::sessions
