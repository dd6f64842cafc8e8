#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

namespace rift::geometry {

/// A rigid motion in space, read `b_from_a`: it takes point coordinates in frame a to frame b.
struct Pose3 {
  double x_m = 0.0;
  double y_m = 0.0;
  double z_m = 0.0;
  double qx = 0.0;  ///< unit quaternion of the rotation
  double qy = 0.0;
  double qz = 0.0;
  double qw = 1.0;

  Eigen::Vector3d Position() const { return {x_m, y_m, z_m}; }
  Eigen::Quaterniond Rotation() const { return {qw, qx, qy, qz}; }
};

/// The same motion for many points: the matrix of the rotation is made once.
class PointMotion3 {
 public:
  explicit PointMotion3(const Pose3& b_from_a)
      : offset_(b_from_a.Position()), rotation_(b_from_a.Rotation().toRotationMatrix()) {}

  Eigen::Vector3d operator*(const Eigen::Vector3d& p_in_a) const {
    return offset_ + rotation_ * p_in_a;
  }

 private:
  Eigen::Vector3d offset_;
  Eigen::Matrix3d rotation_;
};

/// Roll, pitch and yaw in rad of a rotation Rz(yaw) Ry(pitch) Rx(roll), pitch in [-pi/2, pi/2].
inline std::array<double, 3> RollPitchYaw(const Eigen::Matrix3d& rotation) {
  return {std::atan2(rotation(2, 1), rotation(2, 2)),
          std::asin(std::clamp(-rotation(2, 0), -1.0, 1.0)),
          std::atan2(rotation(1, 0), rotation(0, 0))};
}

}  // namespace rift::geometry
