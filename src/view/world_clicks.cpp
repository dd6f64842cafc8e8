#include "rift/view/world_clicks.hpp"

#include <fmt/format.h>

#include <stdexcept>
#include <utility>

#include "rift/view/track_window.hpp"
#include "rift/view/window.hpp"
#include "rift/vision/tracking/world_check.hpp"
#include "rift/vision/tracking/world_frame.hpp"

namespace rift::view {
namespace {

constexpr double kTick_s = 0.02;

std::string Prompt(const std::vector<vision::FloorMark>& points, std::size_t next) {
  return fmt::format("click point {} of {}: {} at x {:g} m, y {:g} m", next + 1, points.size(),
                     points[next].name, points[next].x_m, points[next].y_m);
}

}  // namespace

vision::WorldFrame WorldFromClicks(const vision::WorldSetting& setting,
                                   const std::vector<vision::FloorMark>& points) {
  std::vector<vision::WorldPoint> places;
  for (const vision::FloorMark& point : points) {
    places.push_back({.p_in_world = {point.x_m, point.y_m, point.z_m}});
  }
  vision::RequireFramePoints(places);
  if (const std::string missing = MissingDisplay(); !missing.empty()) {
    throw std::runtime_error(fmt::format("{}: points cannot be clicked, use tags", missing));
  }
  vision::CameraModel camera = setting.session.camera();
  camera.world.reset();
  vision::Capture& capture = setting.session.capture();
  TrackWindow window("rift track: world frame");
  std::vector<vision::WorldPoint> clicked;
  std::optional<vision::Frame> frame;
  while (clicked.size() < points.size()) {
    if (auto next = capture.Next(kTick_s)) {
      setting.session.RequireSize(*next);
      frame = std::move(next);
    }
    if (!(frame && capture.IsRecording())) setting.ThrowIfOver();
    if (setting.is_stopped()) throw std::runtime_error("stopped before the world frame was set");
    TrackScene scene{
        .camera = &camera, .frame = frame ? &*frame : nullptr, .keys = "u: take back   q: quit"};
    scene.status = capture.Status();
    scene.prompts = {Prompt(points, clicked.size())};
    const TrackInput input = window.Show(scene);
    if (input.quit) throw std::runtime_error("ended before the world frame was set");
    if (input.undo && !clicked.empty()) clicked.pop_back();
    for (const Eigen::Vector2d& pixel : input.clicks_px) {
      if (clicked.size() == points.size()) break;
      const std::size_t next = clicked.size();
      clicked.push_back({places[next].p_in_world, pixel, points[next].name});
    }
  }
  vision::CheckPoints(camera, clicked, setting.options.world_limit_m);
  return vision::WorldFromPoints(camera, clicked, fmt::format("{} clicked points", clicked.size()));
}

}  // namespace rift::view
