#pragma once

#include <Eigen/Geometry>

#include "rift/vision/camera/camera_model.hpp"

namespace rift::vision {

/// The one place where the camera's y-down frame is turned y-up. With a world frame: that frame.
/// Without: the camera's own place with x right, y up in the picture and z towards the camera, so
/// that what the camera sees has z < 0.
inline Eigen::Isometry3d MapFromCamera(const CameraModel& camera) {
  if (camera.world) return camera.world->world_from_camera;
  Eigen::Isometry3d y_up_from_camera = Eigen::Isometry3d::Identity();
  y_up_from_camera.linear() = Eigen::Vector3d(1.0, -1.0, -1.0).asDiagonal();
  return y_up_from_camera;
}

}  // namespace rift::vision
