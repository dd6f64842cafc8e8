#include "drive_view.hpp"

#include <chrono>

namespace rift::commands {
namespace {

// A window costs a decoded and drawn picture each time; the tracker needs the processor more.
constexpr std::chrono::milliseconds kPicture{100};
constexpr double kTrailStep_m = 0.002;

view::TrackScene SceneOf(const vision::CameraModel& camera,
                         const experiment::Experiment& experiment) {
  view::TrackScene scene{.camera = &camera};
  for (const control::Waypoint& waypoint : experiment.waypoints) {
    scene.path_m.push_back(waypoint.Position());
    scene.waypoints.push_back({waypoint.name, waypoint.Position()});
  }
  return scene;
}

void Follow(const vision::Sighting& sighting, view::TrackScene& scene) {
  const Eigen::Vector2d place = sighting.map_from_tag.translation().head<2>();
  if (scene.trail_m.empty() || (place - scene.trail_m.back()).norm() > kTrailStep_m) {
    scene.trail_m.push_back(place);
  }
  scene.plane_z_m = sighting.map_from_tag.translation().z();
  scene.latency_s = sighting.latency_s;
}

}  // namespace

void ShowUntilOver(const std::future<DriveRun>& drive, view::TrackWindow& window,
                   const hardware::CameraPoses& poses, const vision::CameraModel& camera,
                   const experiment::Experiment& experiment, DriveOperator& person) {
  view::TrackScene scene = SceneOf(camera, experiment);
  scene.prompts = {"close the window or press q in it to stop the robot"};
  while (drive.wait_for(kPicture) != std::future_status::ready) {
    const hardware::CameraPoses::View view = poses.Seen();
    scene.frame = view.frame.get();
    scene.sighting = view.found.sighting;
    scene.status = poses.Status();
    if (scene.sighting) Follow(*scene.sighting, scene);
    if (window.Show(scene).quit) person.CloseWindow();
  }
}

}  // namespace rift::commands
