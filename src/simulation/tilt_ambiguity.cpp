#include "rift/simulation/tilt_ambiguity.hpp"

#include <cmath>

#include "rift/geometry/pose3.hpp"

namespace rift::simulation {
namespace {

Eigen::Vector3d ToCamera(const AmbiguityOptions& options, const Eigen::Isometry3d& world_from_tag) {
  const Eigen::Vector3d camera(options.camera_x_m, options.camera_y_m, options.camera_z_m);
  return camera - world_from_tag.translation();
}

}  // namespace

double MirroredShare(const AmbiguityOptions& options, const Eigen::Isometry3d& world_from_tag) {
  const Eigen::Vector3d to_camera = ToCamera(options, world_from_tag);
  const double range_m = to_camera.norm();
  const double frontal = to_camera.dot(world_from_tag.linear().col(2)) / range_m;
  if (range_m < options.range_m || frontal < std::cos(options.angle_rad)) return 0.0;
  const Eigen::Vector2d away =
      world_from_tag.translation().head<2>() - Eigen::Vector2d(options.x_m, options.y_m);
  return options.share * std::exp(-0.5 * away.squaredNorm() / std::pow(options.reach_m, 2));
}

Eigen::Isometry3d Mirrored(const AmbiguityOptions& options,
                           const Eigen::Isometry3d& world_from_tag) {
  const Eigen::Vector3d to_camera = ToCamera(options, world_from_tag);
  const Eigen::Vector3d sight = to_camera.normalized();
  // Depths along the line of sight change their sign, and so does the normal, which stays in front.
  Eigen::Isometry3d mirrored = world_from_tag;
  mirrored.linear() = (Eigen::Matrix3d::Identity() - 2.0 * sight * sight.transpose()) *
                      world_from_tag.linear() * Eigen::Vector3d(1.0, 1.0, -1.0).asDiagonal();
  mirrored.translation() += options.nearer * to_camera;
  return mirrored;
}

geometry::Pose2 LevelTag(const AmbiguityOptions& options, const geometry::Pose2& mirrored,
                         double above_m) {
  constexpr int kSteps = 3;  // what mirroring moves hardly changes over the way that it moves
  geometry::Pose2 level = mirrored;
  for (int i = 0; i < kSteps; ++i) {
    Eigen::Isometry3d world_from_tag = Eigen::Isometry3d::Identity();
    world_from_tag.translation() = Eigen::Vector3d(level.x_m, level.y_m, above_m);
    world_from_tag.rotate(Eigen::AngleAxisd(level.yaw_rad, Eigen::Vector3d::UnitZ()));
    if (MirroredShare(options, world_from_tag) <= 0.0) return mirrored;
    const Eigen::Isometry3d seen = Mirrored(options, world_from_tag);
    const double off_rad = mirrored.yaw_rad - geometry::RollPitchYaw(seen.linear())[2];
    level = {level.x_m + mirrored.x_m - seen.translation().x(),
             level.y_m + mirrored.y_m - seen.translation().y(),
             geometry::WrapToPi(level.yaw_rad + off_rad)};
  }
  return level;
}

}  // namespace rift::simulation
