#include "rift/view/drive_view.hpp"

#include <utility>

#include "trail.hpp"

namespace rift::view {
namespace {

void Follow(const vision::Sighting& sighting, TrackScene& scene) {
  const Eigen::Vector2d place = sighting.map_from_tag.translation().head<2>();
  ExtendTrail(place, scene.path_m, scene.robots.front());
  scene.plane_z_m = sighting.map_from_tag.translation().z();
  scene.latency_s = sighting.latency_s;
}

}  // namespace

DriveWish WishOf(const TrackInput& input, bool is_started) {
  if (input.closed) return DriveWish::kStopByClosing;
  const bool is_stop = input.quit || (is_started && input.any_key);
  return is_stop ? DriveWish::kStopByKey : DriveWish::kGoOn;
}

DriveView::DriveView(const vision::CameraModel& camera, const control::Task& task, ShowScene show)
    : start_(task.Start()),
      scene_{.camera = &camera, .robots = {SceneRobot{}}, .keys = ""},
      show_(std::move(show)) {
  for (const control::TimedPose& at : task.IdealPath()) {
    scene_.path_m.push_back(at.world_from_robot.Position());
  }
  for (const control::Waypoint& waypoint : task.waypoints) {
    scene_.waypoints.push_back({waypoint.name, waypoint.Position()});
  }
}

DriveWish DriveView::Show(const vision::Frame* frame,
                          const std::optional<vision::Sighting>& sighting,
                          const vision::CaptureStatus& status, const std::string& placement,
                          bool is_started) {
  scene_.frame = frame;
  scene_.robots.front().sighting = sighting;
  scene_.status = status;
  scene_.prompts.clear();
  scene_.stand_at.reset();
  if (!placement.empty()) {
    scene_.stand_at = start_;
    scene_.prompts.push_back("put the robot into the outline: " + placement);
    ClearTrail(scene_.robots.front());  // it is carried, and not driven
  }
  scene_.prompts.emplace_back(is_started
                                  ? "any key in this window, or closing it, stops the robot"
                                  : "Enter in the terminal starts; q, Escape or closing gives up");
  if (sighting) Follow(*sighting, scene_);
  return WishOf(show_(scene_), is_started);
}

}  // namespace rift::view
