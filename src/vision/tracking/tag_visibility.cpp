#include "rift/vision/tracking/tag_visibility.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "rift/vision/tracking/world_frame.hpp"

namespace rift::vision {

std::optional<double> ShortSide_px(const CameraModel& camera, double size_m,
                                   const Eigen::Vector3d& p_in_world) {
  const Eigen::Isometry3d& world_from_camera = camera.world->world_from_camera;
  const Eigen::Vector2d from_camera = (p_in_world - world_from_camera.translation()).head<2>();
  // Straight below the camera no direction leads away from it.
  const Eigen::Vector2d away = from_camera.norm() > 1e-9 ? Eigen::Vector2d(from_camera.normalized())
                                                         : Eigen::Vector2d(1.0, 0.0);
  const Eigen::Vector2d across(-away.y(), away.x());
  const double h = 0.5 * size_m;
  std::array<Eigen::Vector2d, 4> corners_px;
  const std::array<Eigen::Vector2d, 4> in_tag{{{-h, -h}, {h, -h}, {h, h}, {-h, h}}};
  for (int i = 0; i < 4; ++i) {
    Eigen::Vector3d p = p_in_world;
    p.head<2>() += in_tag[i].x() * away + in_tag[i].y() * across;
    const Eigen::Vector3d p_in_camera = world_from_camera.inverse() * p;
    if (p_in_camera.z() <= 0.0) return std::nullopt;
    corners_px[i] = (camera.k * p_in_camera).hnormalized();
  }
  double shortest_px = HUGE_VAL;
  for (int i = 0; i < 4; ++i) {
    shortest_px = std::min(shortest_px, (corners_px[(i + 1) % 4] - corners_px[i]).norm());
  }
  return shortest_px;
}

std::optional<double> ShortSideInMiddle_px(const CameraModel& camera, const TagOptions& options) {
  if (!camera.world) return std::nullopt;
  const Eigen::Vector2d middle_px(0.5 * camera.width_px - 0.5, 0.5 * camera.height_px - 0.5);
  const auto p_m = MapFromPixel(camera, middle_px, options.height_m);
  if (!p_m) return std::nullopt;
  return ShortSide_px(camera, options.size_m, {p_m->x(), p_m->y(), options.height_m});
}

int DecimateFor(const CameraModel& camera, const TagOptions& options) {
  const std::optional<double> side_px = ShortSideInMiddle_px(camera, options);
  if (!side_px) return options.acquire_decimate;
  // Cells are looked for: search_px is of a square of eight.
  const double of_eight_px = *side_px * 8.0 / ShapeOf(options.family).square;
  return std::clamp(static_cast<int>(of_eight_px / options.search_px), 1, options.acquire_decimate);
}

std::optional<std::string> SmallTagWarning(const CameraModel& camera, const TagOptions& options) {
  const std::optional<double> side_px = ShortSideInMiddle_px(camera, options);
  if (!side_px || *side_px >= kGoodSide_px) return std::nullopt;
  const double least_px = LeastSide_px(options.family);
  return fmt::format(
      "the tag of {:g} m has {:.0f} px in the middle of the picture, {} {:g}: {}; lower the "
      "camera, take more pixels, or print the tag {:.1f} times as large",
      options.size_m, *side_px, *side_px < least_px ? "it takes" : "good are",
      *side_px < least_px ? least_px : kGoodSide_px,
      *side_px < least_px ? "it will not be found" : "poses will be coarse",
      kGoodSide_px / *side_px * 1.1);
}

}  // namespace rift::vision
