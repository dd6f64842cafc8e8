#pragma once

#include "rift/vision/camera/camera_model.hpp"

namespace rift::test {

/// 640 x 480, 1 m above the floor and looking straight down, with a little distortion.
inline vision::CameraModel CameraToCalibrate() {
  vision::CameraModel camera;
  camera.width_px = 640;
  camera.height_px = 480;
  camera.k << 610.0, 0.0, 322.0, 0.0, 612.0, 236.0, 0.0, 0.0, 1.0;
  camera.distortion = {-0.15, 0.05, 0.001, -0.0005, 0.0};
  vision::WorldFrame world;
  world.world_from_camera.linear() = Eigen::Vector3d(1.0, -1.0, -1.0).asDiagonal();
  world.world_from_camera.translation() = Eigen::Vector3d(0.0, 0.0, 1.0);
  camera.world = world;
  return camera;
}

}  // namespace rift::test
