#include "film.hpp"

#include "rift/terminal/print.hpp"
#include "rift/view/video.hpp"
#include "rift/view/window.hpp"

namespace rift::commands {

view::BodyShape ShapeOf(const simulation::BodyOptions& body) {
  return {.chassis_radius_m = body.chassis_radius_m,
          .chassis_height_m = body.chassis_height_m,
          .chassis_bottom_m = body.rim_clearance_m - body.wheel_radius_m,
          .wheel_radius_m = body.wheel_radius_m,
          .wheel_width_m = body.wheel_width_m,
          .track_m = body.track_m};
}

void ShowTask(view::Run& shown, const std::vector<control::Waypoint>& waypoints) {
  for (const control::Waypoint& waypoint : waypoints) {
    shown.waypoints.push_back({waypoint.name, waypoint.Position()});
    shown.reference_m.push_back(waypoint.Position());
  }
}

void ShowFilm(const view::Film& film, const std::string& video, bool window) {
  if (!video.empty()) view::WriteVideo(film, video, {});
  if (!window) return;
  const std::string no_display = view::MissingDisplay();
  if (no_display.empty()) {
    view::PlayInWindow(film, {});
  } else {
    terminal::Say("note: --view shows nothing: " + no_display);
  }
}

}  // namespace rift::commands
