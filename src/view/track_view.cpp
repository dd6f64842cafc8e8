#include "rift/view/track_view.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <utility>

#include "rift/vision/tracking/world_frame.hpp"
#include "trail.hpp"

namespace rift::view {
namespace {

constexpr double kLifted_m = 0.15;  // no robot drives that far between pictures

}  // namespace

TrackView::TrackView(const vision::CameraModel& camera, const std::vector<int>& tag_ids,
                     Content content, ShowScene show)
    : camera_(camera), content_(std::move(content)), show_(std::move(show)) {
  for (const int tag_id : tag_ids) robots_.push_back({.tag_id = tag_id});
  if (camera.world) plane_z_m_ = 0.0;
}

std::vector<geometry::NamedPoint> TrackView::Places() const {
  std::vector<geometry::NamedPoint> places;
  for (const auto* list : {&content_.planned, &recorded_}) {
    for (const control::Waypoint& waypoint : *list) {
      places.push_back({waypoint.name + (waypoint.stop ? "" : " (pass)"), waypoint.Position()});
    }
  }
  return places;
}

std::vector<std::string> TrackView::Prompts(const std::optional<double>& moved_m) const {
  std::vector<std::string> lines;
  if (moved_m) {
    lines.push_back(fmt::format("reference tags {:.1f} mm off their places", 1e3 * *moved_m));
  }
  if (!said_.empty()) lines.push_back(said_);
  return lines;
}

void TrackView::Follow(SceneRobot& robot) {
  const Eigen::Vector3d middle = robot.sighting->map_from_tag.translation();
  const Eigen::Vector2d place = middle.head<2>();
  if (!plane_z_m_) plane_z_m_ = middle.z();
  const bool is_lifted =
      !robot.trail_m.empty() && (place - robot.trail_m.back()).norm() > kLifted_m;
  if (is_lifted) ClearTrail(robot);
  ExtendTrail(place, content_.path_m, robot);
}

bool TrackView::Show(const std::optional<vision::Frame>& frame,
                     const std::vector<std::optional<vision::Sighting>>& seen,
                     const vision::CaptureStatus& status, const std::optional<double>& moved_m) {
  for (std::size_t i = 0; i < robots_.size(); ++i) {
    robots_[i].sighting = i < seen.size() ? seen[i] : std::nullopt;
    if (robots_[i].sighting) Follow(robots_[i]);
  }
  const std::optional<vision::Sighting>& sighting = robots_.front().sighting;
  TrackScene scene{.camera = &camera_,
                   .frame = frame ? &*frame : nullptr,
                   .robots = robots_,
                   .path_m = content_.path_m,
                   .waypoints = Places(),
                   .plane_z_m = plane_z_m_.value_or(0.0),
                   .status = status,
                   .latency_s = sighting ? sighting->latency_s : status.latency_s,
                   .prompts = Prompts(moved_m)};
  const TrackInput input = show_(scene);
  Apply(input, sighting);
  return !input.quit;
}

void TrackView::Apply(const TrackInput& input, const std::optional<vision::Sighting>& sighting) {
  const std::size_t before = recorded_.size();
  for (const Eigen::Vector2d& pixel : input.clicks_px) {
    const auto p_m = plane_z_m_ ? vision::MapFromPixel(camera_, pixel, *plane_z_m_) : std::nullopt;
    if (p_m) {
      Record(*p_m, {});
    } else {
      said_ = "no place: show the robot's tag first, or set a world frame (--world)";
    }
  }
  if (input.here && sighting) {
    const geometry::Pose2 pose = sighting->Planar();
    Record(pose.Position(), pose.yaw_rad * 180.0 / std::numbers::pi);
  }
  if (input.undo && !recorded_.empty()) recorded_.pop_back();
  if (input.toggle_stop && !recorded_.empty()) recorded_.back().stop = !recorded_.back().stop;
  if (input.clear_trail) {
    for (SceneRobot& robot : robots_) ClearTrail(robot);
  }
  const bool has_changed = recorded_.size() != before || (input.toggle_stop && !recorded_.empty());
  if (has_changed && content_.save) content_.save(recorded_);
}

/// Only the first waypoint has a heading: where the robot looks at the start.
void TrackView::Record(const Eigen::Vector2d& p_m, std::optional<double> heading_deg) {
  control::Waypoint waypoint{.x_m = p_m.x(), .y_m = p_m.y()};
  waypoint.name = recorded_.empty() ? "start" : fmt::format("wp{}", recorded_.size());
  if (recorded_.empty()) waypoint.heading_deg = heading_deg;
  recorded_.push_back(waypoint);
  said_ = fmt::format("{}: x {:.3f} m, y {:.3f} m{}", waypoint.name, p_m.x(), p_m.y(),
                      !content_.save ? " (not saved: --record-waypoints FILE)" : "");
}

}  // namespace rift::view
