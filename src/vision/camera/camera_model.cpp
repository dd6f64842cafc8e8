#include "rift/vision/camera/camera_model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <opencv2/calib3d.hpp>
#include <opencv2/core/eigen.hpp>

namespace rift::vision {
namespace {

/// cv::undistortPoints stops after five rounds unless told otherwise, 0.1 px short of the truth at
/// the border of the paper's lens.
const cv::TermCriteria kExact(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 60, 1e-10);

constexpr double kShortestFocal = 0.1, kLongestFocal = 100.0;  // longer sides of the picture

cv::Mat Intrinsics(const CameraModel& camera) {
  cv::Mat k;
  cv::eigen2cv(camera.k, k);
  return k;
}

std::vector<Eigen::Vector2d> ToEigen(const std::vector<cv::Point2d>& points) {
  std::vector<Eigen::Vector2d> result(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) result[i] = {points[i].x, points[i].y};
  return result;
}

}  // namespace

std::optional<std::string> WhyNoLens(const CameraModel& camera) {
  if (camera.width_px == 0 || camera.height_px == 0) return std::nullopt;
  const double longer_px = std::max(camera.width_px, camera.height_px);
  for (const double focal_px : {camera.k(0, 0), camera.k(1, 1)}) {
    if (focal_px >= kShortestFocal * longer_px && focal_px <= kLongestFocal * longer_px) continue;
    return fmt::format(
        "the focal length {:g} px must be {:g} to {:g} times the longer side of the picture, {:g} "
        "px: give it in pixels, its millimetres divided by those of a pixel",
        focal_px, kShortestFocal, kLongestFocal, longer_px);
  }
  const double x_px = camera.k(0, 2), y_px = camera.k(1, 2);
  if (x_px >= 0.0 && x_px <= camera.width_px && y_px >= 0.0 && y_px <= camera.height_px) {
    return std::nullopt;
  }
  return fmt::format(
      "the principal point ({:g}, {:g}) px must be in the picture of {}x{} px: is this the "
      "calibration of another camera, or of pictures of another size?",
      x_px, y_px, camera.width_px, camera.height_px);
}

std::vector<Eigen::Vector2d> PixelsFromPoints(
    const CameraModel& camera, const std::vector<Eigen::Vector3d>& points_in_camera) {
  if (points_in_camera.empty()) return {};
  std::vector<cv::Point3d> points(points_in_camera.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    points[i] = {points_in_camera[i].x(), points_in_camera[i].y(), points_in_camera[i].z()};
  }
  const cv::Vec3d none(0.0, 0.0, 0.0);
  std::vector<cv::Point2d> pixels;
  if (camera.lens == Lens::kEquidistant) {
    cv::fisheye::projectPoints(points, pixels, none, none, Intrinsics(camera), camera.distortion);
  } else {
    cv::projectPoints(points, none, none, Intrinsics(camera), camera.distortion, pixels);
  }
  return ToEigen(pixels);
}

std::vector<Eigen::Vector2d> RaysFromPixels(const CameraModel& camera,
                                            const std::vector<Eigen::Vector2d>& pixels) {
  if (pixels.empty()) return {};
  std::vector<cv::Point2d> bent(pixels.size());
  for (std::size_t i = 0; i < bent.size(); ++i) bent[i] = {pixels[i].x(), pixels[i].y()};
  std::vector<cv::Point2d> rays;
  if (camera.lens == Lens::kEquidistant) {
    cv::fisheye::undistortPoints(bent, rays, Intrinsics(camera), camera.distortion);
  } else {
    cv::undistortPoints(bent, rays, Intrinsics(camera), camera.distortion, cv::noArray(),
                        cv::noArray(), kExact);
  }
  return ToEigen(rays);
}

}  // namespace rift::vision
