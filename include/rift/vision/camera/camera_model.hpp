#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace rift::vision {

/// How the lens bends light, in the words of ROS camera_info.
enum class Lens {
  kPlumbBob,     ///< OpenCV's k1 k2 p1 p2 [k3 [k4 k5 k6]]
  kEquidistant,  ///< OpenCV's fisheye k1 k2 k3 k4
};
constexpr std::array<std::string_view, 2> EnumNames(Lens) { return {"plumb_bob", "equidistant"}; }

/// The last id of the AprilTag family that has most of them, tagStandard41h12.
inline constexpr int kLastTagId = 2114;

/// A reference tag that set the world frame: when it is seen elsewhere, the camera was moved.
struct ReferenceMark {
  int tag_id = 0;
  Eigen::Vector3d p_in_world = Eigen::Vector3d::Zero();  ///< middle of the tag
  Eigen::Vector2d seen_px = Eigen::Vector2d::Zero();     ///< where it was seen then
};

/// The origin of a frame that the robot's own tag set: as good as one look at one tag.
inline constexpr std::string_view kFirstPoseOrigin = "first pose";

/// The floor's frame as this camera sees it: z up, y up in the picture's sense of a map, metres.
struct WorldFrame {
  Eigen::Isometry3d world_from_camera = Eigen::Isometry3d::Identity();
  double residual_m = 0.0;           ///< RMS on the floor of the points that set it
  std::string origin;                ///< what set it, for people: "4 reference tags", "first pose"
  std::vector<ReferenceMark> marks;  ///< none unless tags set it
};

/// A calibrated camera. The camera's own frame is OpenCV's: x right, y down, z forward.
struct CameraModel {
  std::string name;
  int width_px = 0;
  int height_px = 0;
  Lens lens = Lens::kPlumbBob;
  Eigen::Matrix3d k = Eigen::Matrix3d::Identity();  ///< pixels from rays
  std::vector<double> distortion;                   ///< in the lens's order
  double rms_px = 0.0;                              ///< of the calibration; 0 where unknown
  std::optional<WorldFrame> world;
};

/// Why no lens is like that: a focal length beyond 0.1 to 100 times the longer side (a fisheye of
/// 180 degrees has 0.3, one degree of view 57), or a principal point outside of the picture (which
/// cv::calibrateCamera takes for no camera either). None where the picture's size is not known.
std::optional<std::string> WhyNoLens(const CameraModel& camera);

/// A pixel with integer coordinates is a pixel's middle, as in OpenCV: the picture begins at
/// (-0.5, -0.5). A ray is a point on the plane one metre before the camera: (x/z, y/z).

/// Where points (metres, camera frame, z > 0) appear, the lens included.
std::vector<Eigen::Vector2d> PixelsFromPoints(const CameraModel& camera,
                                              const std::vector<Eigen::Vector3d>& points_in_camera);
/// The rays that end in these pixels, to 1e-9 for every pixel of a lens that does not fold the
/// picture over itself.
std::vector<Eigen::Vector2d> RaysFromPixels(const CameraModel& camera,
                                            const std::vector<Eigen::Vector2d>& pixels);

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
