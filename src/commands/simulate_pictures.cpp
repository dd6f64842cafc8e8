#include "simulate_pictures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "figure_file.hpp"
#include "rift/report/figures/simulation_figure.hpp"
#include "rift/view/display.hpp"
#include "rift/view/film.hpp"
#include "rift/view/video.hpp"
#include "rift/view/window.hpp"

namespace rift::commands {
namespace {

constexpr double kGroundStep_m = 0.002;  // the edge of a bump shows

std::vector<report::FloorArea> AreasOf(const simulation::TerrainOptions& terrain) {
  std::vector<report::FloorArea> areas;
  for (const simulation::PatchOptions& patch : terrain.patches) {
    areas.push_back({fmt::format("mu {:g}", patch.mu), patch.x_min_m, patch.x_max_m, patch.y_min_m,
                     patch.y_max_m});
  }
  return areas;
}

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

view::BodyShape ShapeOf(const simulation::BodyOptions& body) {
  return {.chassis_radius_m = body.chassis_radius_m,
          .chassis_height_m = body.chassis_height_m,
          .chassis_bottom_m = body.rim_clearance_m - body.wheel_radius_m,
          .wheel_radius_m = body.wheel_radius_m,
          .wheel_width_m = body.wheel_width_m,
          .track_m = body.track_m};
}

view::Film FilmOf(const experiment::Experiment& experiment, const sweep::SimulatedTrial& trial,
                  const sweep::SimulatedRun& run) {
  const simulation::Terrain terrain(trial.simulation.terrain, trial.image);
  view::Run shown{
      .title = fmt::format("{} on {}", experiment.name, trial.simulation.terrain.surface),
      .body = ShapeOf(trial.simulation.body),
      .height_at = [&](double x_m, double y_m) { return terrain.HeightAt(x_m, y_m); },
      .truth = run.truth,
      .logged = run.result.trajectory,
      .outcome = run.result.reason};
  for (const control::Waypoint& waypoint : trial.waypoints) {
    shown.waypoints.push_back({waypoint.name, waypoint.Position()});
    shown.reference_m.push_back(waypoint.Position());
  }
  for (const report::FloorArea& area : AreasOf(trial.simulation.terrain)) {
    shown.patches.push_back({area.label, area.x_min_m, area.x_max_m, area.y_min_m, area.y_max_m});
  }
  return view::MakeFilm(shown);
}

void ShowFilm(const PictureRequest& request, const view::Film& film) {
  if (!request.video.empty()) view::WriteVideo(film, request.video, {});
  if (!request.window) return;
  const std::string no_display = view::MissingDisplay();
  if (no_display.empty()) {
    view::PlayInWindow(film, {});
  } else {
    fmt::print(stderr, "note: --view shows nothing: {}\n", no_display);
  }
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

void MakePictures(const PictureRequest& request, const experiment::Experiment& experiment,
                  const sweep::SimulatedTrial& trial, const sweep::SimulatedRun& run) {
  if (!request.figure.empty()) DrawFigure(request.figure, experiment, trial, run);
  if (request.video.empty() && !request.window) return;
  ShowFilm(request, FilmOf(experiment, trial, run));
}

}  // namespace rift::commands
