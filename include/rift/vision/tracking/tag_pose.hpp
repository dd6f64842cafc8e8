#pragma once

#include <Eigen/Geometry>
#include <array>
#include <optional>

#include "rift/vision/camera/camera_model.hpp"

namespace rift::vision {

/// Metres and radians: translation, then rotation about the frame's own x, y, z.
using PoseCovariance = Eigen::Matrix<double, 6, 6>;

/// One way for the tag to lie that puts its corners where they were seen. Tag frame: the middle of
/// the square, x right and y up as one reads the tag, z out of the paper.
struct TagPose {
  Eigen::Isometry3d camera_from_tag = Eigen::Isometry3d::Identity();
  PoseCovariance covariance = PoseCovariance::Zero();  ///< in the camera's frame
  double reprojection_px = 0.0;                        ///< RMS distance of the four corners
};

/// A square seen nearly from the front leans one way or the other with almost the same picture: the
/// two local minima [Collins and Bartoli 2014], the better first, each refined to the least squared
/// corner errors. rays: the corners without the lens, in the order of TagCorners. The second is
/// none where there is only one. Both rotations are proper.
struct TagPoses {
  TagPose best;
  std::optional<TagPose> other;
};
std::optional<TagPoses> SolveTagPoses(const CameraModel& camera,
                                      const std::array<Eigen::Vector2d, 4>& rays, double size_m,
                                      double corner_sigma_px);

/// The pose that is likelier when corners are wrong by lens_sigma_px and the tag's normal scatters
/// by tilt_sigma_rad about `up_in_camera`.
const TagPose& LikelierPose(const TagPoses& poses, const Eigen::Vector3d& up_in_camera,
                            double lens_sigma_px, double tilt_sigma_rad);

}  // namespace rift::vision
