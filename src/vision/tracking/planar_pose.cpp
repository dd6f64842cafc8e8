#include "planar_pose.hpp"

#include <cmath>
#include <complex>
#include <opencv2/calib3d.hpp>

#include "opencv_pose.hpp"

namespace rift::vision {
namespace {

/// The plane turned about its normal, and turned over where the camera looks against it.
struct Turn {
  bool is_over = false;
  double angle_rad = 0.0;

  Eigen::Matrix3d TurnedFromPlane() const {
    Eigen::Matrix3d over = Eigen::Matrix3d::Identity();
    if (is_over) over = Eigen::Vector3d(1.0, -1.0, -1.0).asDiagonal();
    return Eigen::AngleAxisd(angle_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix() * over;
  }
};

/// Of the similarities that take the points to the rays: its turn, and how well it fits.
std::complex<double> Similarity(const std::vector<Eigen::Vector2d>& points,
                                const std::vector<Eigen::Vector2d>& rays, bool is_over) {
  const auto count = static_cast<double>(points.size());
  std::complex<double> middle, middle_ray, product;
  const auto at = [&](std::size_t i) {
    return std::complex<double>(points[i].x(), is_over ? -points[i].y() : points[i].y());
  };
  for (std::size_t i = 0; i < points.size(); ++i) {
    middle += at(i) / count;
    middle_ray += std::complex<double>(rays[i].x(), rays[i].y()) / count;
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::complex<double> ray(rays[i].x(), rays[i].y());
    product += std::conj(at(i) - middle) * (ray - middle_ray);
  }
  return product;
}

/// OpenCV gives a rotation as a vector, and IPPE's way to make it is wrong for half a turn, which
/// is what every camera sees that looks straight down, and not safe for no turn at all. Turned so,
/// the plane is seen about a radian from both.
Turn FarFromHalfATurn(const std::vector<Eigen::Vector2d>& points,
                      const std::vector<Eigen::Vector2d>& rays) {
  const std::complex<double> over = Similarity(points, rays, true);
  const std::complex<double> straight = Similarity(points, rays, false);
  const bool is_over = std::abs(over) > std::abs(straight);
  return {is_over, std::arg(is_over ? over : straight) - 1.0};
}

}  // namespace

std::vector<Eigen::Isometry3d> PlanarPoses(const std::vector<Eigen::Vector2d>& in_plane_m,
                                           const std::vector<Eigen::Vector2d>& rays) {
  const Eigen::Matrix3d turned_from_plane = FarFromHalfATurn(in_plane_m, rays).TurnedFromPlane();
  std::vector<cv::Point3d> object;
  std::vector<cv::Point2d> image;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Eigen::Vector3d p =
        turned_from_plane * Eigen::Vector3d(in_plane_m[i].x(), in_plane_m[i].y(), 0.0);
    object.emplace_back(p.x(), p.y(), 0.0);
    image.emplace_back(rays[i].x(), rays[i].y());
  }
  std::vector<cv::Mat> turns, places;
  cv::solvePnPGeneric(object, image, cv::Matx33d::eye(), cv::noArray(), turns, places, false,
                      cv::SOLVEPNP_IPPE);
  std::vector<Eigen::Isometry3d> poses;
  for (std::size_t i = 0; i < turns.size(); ++i) {
    Eigen::Isometry3d pose = IsometryOf(turns[i], places[i]);
    pose.linear() *= turned_from_plane;
    poses.push_back(pose);
  }
  return poses;
}

}  // namespace rift::vision
