#pragma once

#include <Eigen/Geometry>
#include <array>
#include <optional>

#include "rift/vision/camera/camera_model.hpp"
#include "rift/vision/tracking/tag_options.hpp"

namespace rift::vision {

/// Metres and radians: translation, then rotation about the frame's own x, y, z.
using PoseCovariance = Eigen::Matrix<double, 6, 6>;

/// Of x0, y0, x1, y1, ... of the four corners without the lens, pixels squared.
using CornerCovariance = Eigen::Matrix<double, 8, 8>;

/// The corners of a tag without the lens, as they were measured.
struct MeasuredCorners {
  std::array<Eigen::Vector2d, 4> rays;  ///< in the order of TagCorners
  CornerCovariance covariance = CornerCovariance::Identity();
};

/// What is known of a tag's pose before it is seen: its middle lies on a plane, its normal is that
/// of the plane, both within normal errors.
struct FloorPrior {
  Eigen::Vector3d up_in_camera = Eigen::Vector3d::UnitZ();  ///< the plane's unit normal
  double offset_m = 0.0;                                    ///< up_in_camera . p of its points
  double height_sigma_m = 0.0;
  double tilt_sigma_rad = 0.0;  ///< about each of two axes in the plane
};

/// The plane of the tag in front of a camera. None without a floor: no world frame, one that the
/// first pose of the same tag set, or free ground.
std::optional<FloorPrior> FloorPriorOf(const CameraModel& camera, const TagOptions& options);

/// One way for the tag to lie that puts its corners where they were seen. Tag frame: the middle of
/// the square, x right and y up as one reads the tag, z out of the paper.
struct TagPose {
  Eigen::Isometry3d camera_from_tag = Eigen::Isometry3d::Identity();
  PoseCovariance covariance = PoseCovariance::Zero();  ///< in the camera's frame
  double reprojection_px = 0.0;                        ///< RMS distance of the four corners
};

/// A square seen nearly from the front leans one way or the other with almost the same picture: the
/// two local minima [Collins and Bartoli 2014], the better first, each refined to the least squared
/// corner errors. The second is none where there is only one. Both rotations are proper. The
/// covariance is that of the corners carried through the fit.
struct TagPoses {
  TagPose best;
  std::optional<TagPose> other;
};
std::optional<TagPoses> SolveTagPoses(const CameraModel& camera, const MeasuredCorners& corners,
                                      double size_m);

/// The maximum a posteriori pose on the floor, started at `start` (camera_from_tag). Corner errors
/// are weighed with `lens_sigma_px`, since a lens that is wrong there must not lift the tag off the
/// floor; the covariance is the estimate's own: that of the corners and of the prior carried
/// through those weights.
TagPose PoseOnFloor(const CameraModel& camera, const MeasuredCorners& corners, double size_m,
                    const FloorPrior& prior, double lens_sigma_px, const Eigen::Isometry3d& start);

/// The pose that is likelier when corners are wrong by lens_sigma_px and the tag's normal scatters
/// by tilt_sigma_rad about `up_in_camera`.
const TagPose& LikelierPose(const TagPoses& poses, const Eigen::Vector3d& up_in_camera,
                            double lens_sigma_px, double tilt_sigma_rad);

}  // namespace rift::vision
