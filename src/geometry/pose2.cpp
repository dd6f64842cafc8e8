#include "rift/geometry/pose2.hpp"

#include <cmath>

namespace rift::geometry {

Eigen::Vector2d Pose2::Forward() const { return {std::cos(yaw_rad), std::sin(yaw_rad)}; }

bool Pose2::IsFinite() const {
  return std::isfinite(x_m) && std::isfinite(y_m) && std::isfinite(yaw_rad);
}

Eigen::Vector2d operator*(const Pose2& b_from_a, const Eigen::Vector2d& p_in_a) {
  return PointMotion(b_from_a) * p_in_a;
}

Pose2 operator*(const Pose2& c_from_b, const Pose2& b_from_a) {
  const Eigen::Vector2d origin_in_c = c_from_b * b_from_a.Position();
  return {origin_in_c.x(), origin_in_c.y(), WrapToPi(c_from_b.yaw_rad + b_from_a.yaw_rad)};
}

Pose2 Inverse(const Pose2& b_from_a) {
  const Pose2 rotation{0.0, 0.0, -b_from_a.yaw_rad};
  const Eigen::Vector2d origin = rotation * Eigen::Vector2d(-b_from_a.Position());
  return {origin.x(), origin.y(), WrapToPi(-b_from_a.yaw_rad)};
}

}  // namespace rift::geometry
