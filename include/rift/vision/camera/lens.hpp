#pragma once

#include <Eigen/Core>
#include <vector>

#include "rift/vision/camera/camera_model.hpp"

namespace rift::vision {

/// A pixel with integer coordinates is a pixel's middle, as in OpenCV: the picture begins at
/// (-0.5, -0.5). A ray is a point on the plane one metre before the camera: (x/z, y/z).

/// Where points (metres, camera frame, z > 0) appear, the lens included.
std::vector<Eigen::Vector2d> PixelsFromPoints(const CameraModel& camera,
                                              const std::vector<Eigen::Vector3d>& points_in_camera);
/// The rays that end in these pixels, to 1e-9 for every pixel of a lens that does not fold the
/// picture over itself.
std::vector<Eigen::Vector2d> RaysFromPixels(const CameraModel& camera,
                                            const std::vector<Eigen::Vector2d>& pixels);

}  // namespace rift::vision
