#pragma once

#include <Eigen/Geometry>

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

}  // namespace rift::geometry
