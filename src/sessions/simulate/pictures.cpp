#include "rift/sessions/simulate/pictures.hpp"

#include <fmt/format.h>

#include <cmath>
#include <vector>

#include "rift/report/figures/figures.hpp"

namespace rift::sessions {
namespace {

constexpr double kGroundStep_m = 0.002;  // the edge of a bump shows
constexpr double kBeyond_m = 0.1;

/// On the way on which the robot looks.
Eigen::Vector2d PointAhead(const trajectory::StampedPose& pose, double ahead_m) {
  return {pose.x_m + ahead_m * std::cos(pose.yaw_rad), pose.y_m + ahead_m * std::sin(pose.yaw_rad)};
}

/// The ground under the robot's path in the order in which it was driven, and a little beyond both
/// ends: as a robot drives to and fro, a place in x has more than one height.
std::vector<Eigen::Vector2d> GroundProfile(const simulation::Terrain& terrain,
                                           const trajectory::Trajectory& truth) {
  std::vector<Eigen::Vector2d> path_m{PointAhead(truth.poses.front(), -kBeyond_m)};
  for (const trajectory::StampedPose& pose : truth.poses) path_m.push_back(PointAhead(pose, 0.0));
  path_m.push_back(PointAhead(truth.poses.back(), kBeyond_m));
  std::vector<Eigen::Vector2d> profile;
  const auto add = [&](const Eigen::Vector2d& at_m) {
    const double z_m = terrain.HeightAt(at_m.x(), at_m.y());
    if (std::isfinite(z_m)) profile.emplace_back(at_m.x(), z_m);
  };
  add(path_m.front());
  for (size_t i = 1; i < path_m.size(); ++i) {
    const Eigen::Vector2d way_m = path_m[i] - path_m[i - 1];
    const long steps =
        std::lround(std::ceil(way_m.norm() / kGroundStep_m));  // none where it stands
    for (long k = 1; k <= steps; ++k) {
      add(path_m[i - 1] + static_cast<double>(k) / static_cast<double>(steps) * way_m);
    }
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
