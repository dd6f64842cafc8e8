#include "simulate_pictures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "figure_file.hpp"
#include "rift/report/figures/simulation_figure.hpp"

namespace rift::commands {
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

}  // namespace

void AddPictureFlags(CLI::App& app, PictureRequest& request) {
  app.add_option("--figure", request.figure, "draw path, heights, speed and powers")
      ->type_name("FILE.svg|FILE.png");
  app.add_option("--video", request.video, "film the run from above and from the side")
      ->type_name("FILE.mp4");
  app.add_flag("--view", request.window, "play that film in a window");
}

void CheckPictureNames(const PictureRequest& request) {
  if (!request.figure.empty()) RequireFigureName(request.figure);
  if (request.video.empty() || request.video.ends_with(".mp4")) return;
  throw std::invalid_argument(fmt::format("--video {}: the name must end in .mp4", request.video));
}

std::vector<geometry::FloorArea> AreasOf(const simulation::TerrainOptions& terrain) {
  std::vector<geometry::FloorArea> areas;
  for (const simulation::PatchOptions& patch : terrain.patches) {
    areas.push_back({fmt::format("mu {:g}", patch.mu), patch.x_min_m, patch.x_max_m, patch.y_min_m,
                     patch.y_max_m});
  }
  return areas;
}

void DrawFigure(const std::string& path, const experiment::Experiment& experiment,
                const sweep::SimulatedTrial& trial, const sweep::SimulatedRun& run) {
  const simulation::Terrain terrain(trial.simulation.terrain, trial.image);
  report::SimulatedTrial drawn{.name = experiment.name,
                               .truth = run.truth,
                               .logged = run.result.trajectory,
                               .areas = AreasOf(trial.simulation.terrain),
                               .ground_xz_m = GroundProfile(terrain, run.truth)};
  for (const control::Waypoint& waypoint : trial.waypoints) {
    drawn.waypoints.push_back({waypoint.name, waypoint.Position()});
  }
  WriteFigure(path, report::SimulationFigure(drawn));
}

}  // namespace rift::commands
