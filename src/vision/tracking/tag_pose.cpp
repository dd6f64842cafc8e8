#include "rift/vision/tracking/tag_pose.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cassert>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <opencv2/core/eigen.hpp>
#include <vector>

namespace rift::vision {
namespace {

constexpr int kRounds = 8;

std::array<Eigen::Vector3d, 4> CornersInTag(double size_m) {
  const double h = 0.5 * size_m;
  return {{{-h, -h, 0.0}, {h, -h, 0.0}, {h, h, 0.0}, {-h, h, 0.0}}};
}

Eigen::Matrix3d CrossMatrix(const Eigen::Vector3d& v) {
  Eigen::Matrix3d cross;
  cross << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return cross;
}

/// Corner errors in pixels and how they change with a small move and turn of the tag.
struct Linearised {
  Eigen::Matrix<double, 8, 1> error;
  Eigen::Matrix<double, 8, 6> jacobian;
};

Linearised Linearise(const CameraModel& camera, const std::array<Eigen::Vector2d, 4>& rays,
                     const std::array<Eigen::Vector3d, 4>& corners, const Eigen::Isometry3d& pose) {
  const Eigen::DiagonalMatrix<double, 2> focal(camera.k(0, 0), camera.k(1, 1));
  Linearised result;
  for (int i = 0; i < 4; ++i) {
    const Eigen::Vector3d arm = pose.linear() * corners[i];
    const Eigen::Vector3d p = arm + pose.translation();
    Eigen::Matrix<double, 2, 3> ray_by_point;
    ray_by_point << 1.0 / p.z(), 0.0, -p.x() / (p.z() * p.z()),  //
        0.0, 1.0 / p.z(), -p.y() / (p.z() * p.z());
    result.error.segment<2>(2 * i) = focal * (p.hnormalized() - rays[i]);
    result.jacobian.block<2, 3>(2 * i, 0) = focal * ray_by_point;
    result.jacobian.block<2, 3>(2 * i, 3) = focal * ray_by_point * -CrossMatrix(arm);
  }
  return result;
}

Eigen::Isometry3d Moved(const Eigen::Isometry3d& pose, const Eigen::Matrix<double, 6, 1>& step) {
  const Eigen::Vector3d turn = step.tail<3>();
  Eigen::Isometry3d moved = pose;
  moved.translation() += step.head<3>();
  if (turn.norm() > 1e-15) {
    moved.linear() = Eigen::AngleAxisd(turn.norm(), turn.normalized()) * pose.linear();
  }
  return moved;
}

/// Gauss-Newton; a step that makes it worse is halved.
TagPose Refine(const CameraModel& camera, const std::array<Eigen::Vector2d, 4>& rays, double size_m,
               double corner_sigma_px, Eigen::Isometry3d pose) {
  const auto corners = CornersInTag(size_m);
  Linearised now = Linearise(camera, rays, corners, pose);
  for (int round = 0; round < kRounds; ++round) {
    Eigen::Matrix<double, 6, 1> step = -(now.jacobian.transpose() * now.jacobian)
                                            .ldlt()
                                            .solve(now.jacobian.transpose() * now.error);
    Eigen::Isometry3d next = Moved(pose, step);
    Linearised there = Linearise(camera, rays, corners, next);
    for (int half = 0; half < 4 && there.error.norm() > now.error.norm(); ++half) {
      step *= 0.5;
      next = Moved(pose, step);
      there = Linearise(camera, rays, corners, next);
    }
    if (there.error.norm() > now.error.norm()) break;
    pose = next;
    now = there;
    if (step.norm() < 1e-10) break;
  }
  const PoseCovariance information = now.jacobian.transpose() * now.jacobian;
  return {pose, information.inverse() * corner_sigma_px * corner_sigma_px, now.error.norm() / 2.0};
}

std::vector<Eigen::Isometry3d> PlanarSolutions(const std::array<Eigen::Vector2d, 4>& rays,
                                               double size_m) {
  std::vector<cv::Point3d> object;
  std::vector<cv::Point2d> image;
  for (const Eigen::Vector3d& c : CornersInTag(size_m)) object.emplace_back(c.x(), c.y(), c.z());
  for (const Eigen::Vector2d& ray : rays) image.emplace_back(ray.x(), ray.y());
  std::vector<cv::Mat> turns, places;
  cv::solvePnPGeneric(object, image, cv::Matx33d::eye(), cv::noArray(), turns, places, false,
                      cv::SOLVEPNP_IPPE);
  std::vector<Eigen::Isometry3d> poses;
  for (std::size_t i = 0; i < turns.size(); ++i) {
    cv::Matx33d rotation;
    cv::Rodrigues(turns[i], rotation);
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    Eigen::Matrix3d linear;
    cv::cv2eigen(rotation, linear);
    pose.linear() = linear;
    pose.translation() =
        Eigen::Vector3d(places[i].at<double>(0), places[i].at<double>(1), places[i].at<double>(2));
    poses.push_back(pose);
  }
  return poses;
}

bool IsSeenFromTheFront(const Eigen::Isometry3d& camera_from_tag) {
  return camera_from_tag.translation().z() > 0.0 &&
         camera_from_tag.linear().col(2).dot(camera_from_tag.translation()) < 0.0;
}

double Misfit(const TagPose& pose, const Eigen::Vector3d& up_in_camera, double lens_sigma_px,
              double tilt_sigma_rad) {
  const Eigen::Vector3d normal = pose.camera_from_tag.linear().col(2);
  const double tilt_rad = std::atan2(normal.cross(up_in_camera).norm(), normal.dot(up_in_camera));
  return 4.0 * std::pow(pose.reprojection_px / lens_sigma_px, 2) +
         std::pow(tilt_rad / tilt_sigma_rad, 2);
}

}  // namespace

std::optional<TagPoses> SolveTagPoses(const CameraModel& camera,
                                      const std::array<Eigen::Vector2d, 4>& rays, double size_m,
                                      double corner_sigma_px) {
  std::vector<TagPose> found;
  for (const Eigen::Isometry3d& start : PlanarSolutions(rays, size_m)) {
    const TagPose pose = Refine(camera, rays, size_m, corner_sigma_px, start);
    if (!pose.camera_from_tag.matrix().allFinite() || !IsSeenFromTheFront(pose.camera_from_tag)) {
      continue;
    }
    assert(pose.camera_from_tag.linear().determinant() > 0.0);
    found.push_back(pose);
  }
  if (found.empty()) return std::nullopt;
  if (found.size() == 1) return TagPoses{found[0], std::nullopt};
  if (found[1].reprojection_px < found[0].reprojection_px) std::swap(found[0], found[1]);
  return TagPoses{found[0], found[1]};
}

const TagPose& LikelierPose(const TagPoses& poses, const Eigen::Vector3d& up_in_camera,
                            double lens_sigma_px, double tilt_sigma_rad) {
  if (!poses.other) return poses.best;
  const double best = Misfit(poses.best, up_in_camera, lens_sigma_px, tilt_sigma_rad);
  const double other = Misfit(*poses.other, up_in_camera, lens_sigma_px, tilt_sigma_rad);
  return other < best ? *poses.other : poses.best;
}

}  // namespace rift::vision
