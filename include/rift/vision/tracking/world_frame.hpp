#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

#include "rift/vision/camera/camera_model.hpp"
#include "rift/vision/tracking/tag_detector.hpp"

namespace rift::vision {

/// A point whose place in the world is known and that was seen.
struct WorldPoint {
  Eigen::Vector3d p_in_world = Eigen::Vector3d::Zero();  ///< metres, z = 0 on the floor
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
  std::string name;  ///< for messages: "tag 3"
};

/// Throws std::invalid_argument for fewer than four points, and for points on a line, which make no
/// frame wherever they are seen.
void RequireFramePoints(const std::vector<WorldPoint>& points);

/// Poses the camera by four or more points (both planar solutions [Collins and Bartoli 2014], the
/// one above the floor, refined). Throws std::invalid_argument, saying what to do, for fewer
/// points, points on a line, or points that only a camera below the floor could see so, which is
/// what coordinates with y down look like.
WorldFrame WorldFromPoints(const CameraModel& camera, const std::vector<WorldPoint>& points,
                           const std::string& origin);

/// The same from reference tags; `tags` holds where the middle of each lies, `seen` what was
/// detected. Tags that are not seen are left out; throws as above when fewer than four are left,
/// and when they do not fit each other within `limit_m` (see CheckPoints).
WorldFrame WorldFromTags(const CameraModel& camera, const std::vector<ReferenceMark>& tags,
                         const std::vector<TagDetection>& seen, double limit_m);

/// Origin on the floor below the robot's tag, x where the robot looks, z along the tag's normal;
/// several sightings of the robot at rest are averaged. The residual is their scatter, RMS.
/// tag_height_m: of the tag above the floor. Throws std::invalid_argument without a sighting.
WorldFrame WorldFromFirstPose(const std::vector<Eigen::Isometry3d>& camera_from_tag,
                              double tag_height_m);

/// How far, RMS on the floor, the reference tags lie from where they set the world frame. Nothing
/// where the frame has no marks or none of them is seen. Of several tags of one id the nearest
/// counts.
std::optional<double> MovedBy_m(const CameraModel& camera, const std::vector<TagDetection>& seen);

/// Where the ray of a pixel meets the plane z = z_m of the map (MapFromCamera); nothing when it
/// does not.
std::optional<Eigen::Vector2d> MapFromPixel(const CameraModel& camera, const Eigen::Vector2d& pixel,
                                            double z_m);

/// The middle of a tag in the picture, the lens left in: where its diagonals cross without lens.
Eigen::Vector2d MiddlePixel(const CameraModel& camera, const TagCorners& corners);

}  // namespace rift::vision
