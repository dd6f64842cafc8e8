#include "rift/twin/overhead_camera.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace rift::twin {
namespace {

constexpr int kWidth_px = 1920;
constexpr int kHeight_px = 1080;
constexpr double kFocal_px = 1092.0;
constexpr double kMargin_m = 0.10;  // the robot's body, and how far it may stray

Eigen::AlignedBox2d BoxOf(const std::vector<control::Waypoint>& waypoints) {
  Eigen::AlignedBox2d box;
  for (const control::Waypoint& waypoint : waypoints) box.extend(waypoint.Position());
  return box;
}

/// The height from which the whole task is seen.
double NeededHeight_m(const Eigen::AlignedBox2d& box) {
  const Eigen::Vector2d half = 0.5 * box.sizes() + Eigen::Vector2d::Constant(kMargin_m);
  return std::max(half.x() / (0.5 * kWidth_px), half.y() / (0.5 * kHeight_px)) * kFocal_px;
}

}  // namespace

vision::CameraModel OverheadCamera(const std::vector<control::Waypoint>& waypoints,
                                   const TwinOptions& options) {
  const Eigen::AlignedBox2d box = BoxOf(waypoints);
  if (const double needed_m = NeededHeight_m(box); needed_m > options.camera_height_m) {
    throw std::invalid_argument(
        fmt::format("twin.camera_height_m is {:g}, but to see all waypoints and {:g} m around them "
                    "the camera must hang at {:.2f} m",
                    options.camera_height_m, kMargin_m, std::ceil(100.0 * needed_m) / 100.0));
  }
  vision::CameraModel camera;
  camera.name = "twin";
  camera.width_px = kWidth_px;
  camera.height_px = kHeight_px;
  camera.k << kFocal_px, 0.0, 958.0, 0.0, kFocal_px, 543.0, 0.0, 0.0, 1.0;
  camera.distortion = {0.06, -0.09, 0.001, -0.001, 0.02};
  vision::WorldFrame world;
  // The picture's y runs down, the world's up, and the camera looks along -z.
  world.world_from_camera.linear() = Eigen::Vector3d(1.0, -1.0, -1.0).asDiagonal();
  world.world_from_camera.translation() << box.center(), options.camera_height_m;
  world.origin = "as built";
  camera.world = world;
  return camera;
}

}  // namespace rift::twin
