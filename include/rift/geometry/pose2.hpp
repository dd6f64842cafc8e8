#pragma once

#include <Eigen/Core>

#include <cmath>
#include <numbers>

namespace rift::geometry {

inline constexpr double kPi = std::numbers::pi;

constexpr double RadFromDeg(double angle_deg) { return angle_deg * (kPi / 180.0); }
constexpr double DegFromRad(double angle_rad) { return angle_rad * (180.0 / kPi); }

/// The same direction in [-pi, pi]. NaN and infinities become NaN.
inline double WrapToPi(double angle_rad) {
  // The remainder of these is the angle itself, bit for bit, at 15 times the price.
  if (std::abs(angle_rad) <= kPi) return angle_rad;
  return std::remainder(angle_rad, 2.0 * kPi);
}

/// A planar rigid motion, read `b_from_a`: it takes point coordinates in frame a to frame b.
/// As the pose of a body it is `world_from_body`. World frame: x right, y up, z towards the
/// viewer; yaw counter-clockwise from +x.
struct Pose2 {
  double x_m = 0.0;
  double y_m = 0.0;
  double yaw_rad = 0.0;

  Eigen::Vector2d Position() const { return {x_m, y_m}; }
  /// Unit vector of the body's forward axis.
  Eigen::Vector2d Forward() const;
  bool IsFinite() const;

  friend bool operator==(const Pose2&, const Pose2&) = default;
};

/// c_from_a = c_from_b * b_from_a; the yaw of the result lies in [-pi, pi].
Pose2 operator*(const Pose2& c_from_b, const Pose2& b_from_a);

/// p_in_b = b_from_a * p_in_a.
Eigen::Vector2d operator*(const Pose2& b_from_a, const Eigen::Vector2d& p_in_a);

/// The same motion for many points: sine and cosine are taken once.
class PointMotion {
 public:
  explicit PointMotion(const Pose2& b_from_a)
      : offset_(b_from_a.Position()), forward_(b_from_a.Forward()) {}

  Eigen::Vector2d operator*(const Eigen::Vector2d& p_in_a) const {
    return {offset_.x() + forward_.x() * p_in_a.x() - forward_.y() * p_in_a.y(),
            offset_.y() + forward_.y() * p_in_a.x() + forward_.x() * p_in_a.y()};
  }

 private:
  Eigen::Vector2d offset_;
  Eigen::Vector2d forward_;
};

/// a_from_b, given b_from_a.
Pose2 Inverse(const Pose2& b_from_a);

}  // namespace rift::geometry
