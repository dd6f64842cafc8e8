#include "rift/vision/tracking/tag_pose.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cassert>
#include <cmath>
#include <vector>

#include "planar_pose.hpp"

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

using Step = Eigen::Matrix<double, 6, 1>;

/// The normal equations of a fit at one pose: information x step = -gradient.
struct Normal {
  PoseCovariance information;
  Step gradient;
  double cost;
};

/// Gauss-Newton; a step that makes it worse is halved. normal_at(pose) gives the equations there.
template <class NormalAt>
Eigen::Isometry3d Minimise(Eigen::Isometry3d pose, NormalAt&& normal_at) {
  Normal now = normal_at(pose);
  for (int round = 0; round < kRounds; ++round) {
    Step step = -now.information.ldlt().solve(now.gradient);
    Eigen::Isometry3d next = Moved(pose, step);
    Normal there = normal_at(next);
    for (int half = 0; half < 4 && there.cost > now.cost; ++half) {
      step *= 0.5;
      next = Moved(pose, step);
      there = normal_at(next);
    }
    if (there.cost > now.cost) break;
    pose = next;
    now = there;
    if (step.norm() < 1e-10) break;
  }
  return pose;
}

TagPose Refine(const CameraModel& camera, const MeasuredCorners& corners, double size_m,
               const Eigen::Isometry3d& start) {
  const auto in_tag = CornersInTag(size_m);
  const Eigen::Isometry3d pose = Minimise(start, [&](const Eigen::Isometry3d& at) {
    const Linearised l = Linearise(camera, corners.rays, in_tag, at);
    return Normal{l.jacobian.transpose() * l.jacobian, l.jacobian.transpose() * l.error,
                  l.error.squaredNorm()};
  });
  const Linearised l = Linearise(camera, corners.rays, in_tag, pose);
  const Eigen::Matrix<double, 6, 8> pose_by_corners =
      (l.jacobian.transpose() * l.jacobian).inverse() * l.jacobian.transpose();
  return {pose, pose_by_corners * corners.covariance * pose_by_corners.transpose(),
          l.error.norm() / 2.0};
}

/// How far the pose is from the floor's plane and normal, in sigmas: height, then two tilts.
struct OffFloor {
  Eigen::Vector3d error;
  Eigen::Matrix<double, 3, 6> jacobian = Eigen::Matrix<double, 3, 6>::Zero();
};

OffFloor OffFloorOf(const FloorPrior& prior, const Eigen::Isometry3d& pose) {
  const Eigen::Vector3d& up = prior.up_in_camera;
  const Eigen::Vector3d across = up.unitOrthogonal();
  const Eigen::Vector3d along = up.cross(across);
  const Eigen::Vector3d normal = pose.linear().col(2);
  const Eigen::Matrix3d normal_by_turn = -CrossMatrix(normal);
  OffFloor off;
  off.error << (up.dot(pose.translation()) - prior.offset_m) / prior.height_sigma_m,
      across.dot(normal) / prior.tilt_sigma_rad, along.dot(normal) / prior.tilt_sigma_rad;
  off.jacobian.block<1, 3>(0, 0) = up.transpose() / prior.height_sigma_m;
  off.jacobian.block<1, 3>(1, 3) = across.transpose() * normal_by_turn / prior.tilt_sigma_rad;
  off.jacobian.block<1, 3>(2, 3) = along.transpose() * normal_by_turn / prior.tilt_sigma_rad;
  return off;
}

std::vector<Eigen::Isometry3d> PlanarSolutions(const std::array<Eigen::Vector2d, 4>& rays,
                                               double size_m) {
  std::vector<Eigen::Vector2d> corners;
  for (const Eigen::Vector3d& corner : CornersInTag(size_m)) corners.push_back(corner.head<2>());
  return PlanarPoses(corners, {rays.begin(), rays.end()});
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

std::optional<FloorPrior> FloorPriorOf(const CameraModel& camera, const TagOptions& options) {
  const bool has_floor = camera.world && camera.world->origin != kFirstPoseOrigin;
  if (!has_floor || options.ground == Ground::kFree) return std::nullopt;
  const bool is_flat = options.ground == Ground::kFlat;
  const Eigen::Isometry3d camera_from_world = camera.world->world_from_camera.inverse();
  FloorPrior prior;
  prior.up_in_camera = camera_from_world.linear().col(2);
  prior.offset_m =
      prior.up_in_camera.dot(camera_from_world * Eigen::Vector3d(0.0, 0.0, options.height_m));
  prior.height_sigma_m = is_flat ? options.flat_height_sigma_m : options.bump_height_sigma_m;
  prior.tilt_sigma_rad = is_flat ? options.flat_tilt_sigma_rad : options.bump_tilt_sigma_rad;
  return prior;
}

TagPose PoseOnFloor(const CameraModel& camera, const MeasuredCorners& corners, double size_m,
                    const FloorPrior& prior, double lens_sigma_px, const Eigen::Isometry3d& start) {
  const auto in_tag = CornersInTag(size_m);
  const CornerCovariance weight =
      (corners.covariance + lens_sigma_px * lens_sigma_px * CornerCovariance::Identity()).inverse();
  const Eigen::Isometry3d pose = Minimise(start, [&](const Eigen::Isometry3d& at) {
    const Linearised l = Linearise(camera, corners.rays, in_tag, at);
    const OffFloor off = OffFloorOf(prior, at);
    return Normal{
        l.jacobian.transpose() * weight * l.jacobian + off.jacobian.transpose() * off.jacobian,
        l.jacobian.transpose() * weight * l.error + off.jacobian.transpose() * off.error,
        l.error.dot(weight * l.error) + off.error.squaredNorm()};
  });
  const Linearised l = Linearise(camera, corners.rays, in_tag, pose);
  const OffFloor off = OffFloorOf(prior, pose);
  const PoseCovariance of_prior = off.jacobian.transpose() * off.jacobian;
  const Eigen::Matrix<double, 6, 8> weighed = l.jacobian.transpose() * weight;
  const PoseCovariance gain = (weighed * l.jacobian + of_prior).inverse();
  const PoseCovariance spread = weighed * corners.covariance * weighed.transpose() + of_prior;
  return {pose, gain * spread * gain.transpose(), l.error.norm() / 2.0};
}

std::optional<TagPoses> SolveTagPoses(const CameraModel& camera, const MeasuredCorners& corners,
                                      double size_m) {
  std::vector<TagPose> found;
  for (const Eigen::Isometry3d& start : PlanarSolutions(corners.rays, size_m)) {
    const TagPose pose = Refine(camera, corners, size_m, start);
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
