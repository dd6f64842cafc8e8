#pragma once

#include "rift/vision/camera/camera_model.hpp"

namespace rift::test {

/// The authors' calibration of their Victure SC30, hung 0.87 m above the floor's origin and looking
/// straight down: its y runs down the picture, the world's runs up.
inline vision::CameraModel PaperCamera(double height_m = 0.87) {
  vision::CameraModel camera;
  camera.name = "paper";
  camera.width_px = 1920;
  camera.height_px = 1080;
  camera.k << 1091.4, 0.0, 908.9, 0.0, 1095.7, 643.0, 0.0, 0.0, 1.0;
  camera.distortion = {0.239, -0.435, 0.0123, -0.0021, 0.252};
  vision::WorldFrame world;
  world.world_from_camera.linear() = Eigen::Vector3d(1.0, -1.0, -1.0).asDiagonal();
  world.world_from_camera.translation() = Eigen::Vector3d(0.0, 0.0, height_m);
  world.origin = "as built";
  camera.world = world;
  return camera;
}

}  // namespace rift::test
