#include "rift/simulation/tilt_ambiguity.hpp"

#include <cmath>

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

}  // namespace rift::simulation
