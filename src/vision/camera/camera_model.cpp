#include "rift/vision/camera/camera_model.hpp"

#include <opencv2/calib3d.hpp>
#include <opencv2/core/eigen.hpp>

namespace rift::vision {
namespace {

/// cv::undistortPoints stops after five rounds unless told otherwise, 0.1 px short of the truth at
/// the border of the paper's lens.
const cv::TermCriteria kExact(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 60, 1e-10);

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
