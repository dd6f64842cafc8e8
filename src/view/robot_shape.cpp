#include "robot_shape.hpp"

#include <Eigen/Geometry>
#include <cmath>

#include "rift/geometry/angle.hpp"

namespace rift::view {
namespace {

constexpr int kCorners = 48;
constexpr double kArrowReach = 1.5;  // of the radius

Eigen::Isometry3d WorldFromRobot(const Scene& scene) {
  Eigen::Isometry3d world_from_robot = Eigen::Isometry3d::Identity();
  world_from_robot.translation() =
      Eigen::Vector3d(scene.world_from_robot.x_m, scene.world_from_robot.y_m, scene.z_m);
  world_from_robot.linear() =
      (Eigen::AngleAxisd(scene.world_from_robot.yaw_rad, Eigen::Vector3d::UnitZ()) *
       Eigen::AngleAxisd(scene.pitch_rad, Eigen::Vector3d::UnitY()) *
       Eigen::AngleAxisd(scene.roll_rad, Eigen::Vector3d::UnitX()))
          .toRotationMatrix();
  return world_from_robot;
}

// The rims of a cylinder of this radius about `axis`, from `low` to `high` along it.
std::vector<Eigen::Vector3d> Cylinder(const Eigen::Isometry3d& world_from_robot,
                                      const Eigen::Vector3d& axis, double radius_m, double low_m,
                                      double high_m) {
  const Eigen::Vector3d u = Eigen::Vector3d::UnitX(), v = axis.cross(u);
  std::vector<Eigen::Vector3d> rims;
  for (int i = 0; i < kCorners; ++i) {
    const double angle_rad = 2.0 * geometry::kPi * i / kCorners;
    const Eigen::Vector3d out = radius_m * (std::cos(angle_rad) * u + std::sin(angle_rad) * v);
    rims.push_back(world_from_robot * (out + low_m * axis));
    rims.push_back(world_from_robot * (out + high_m * axis));
  }
  return rims;
}

}  // namespace

RobotShape ShapeOf(const BodyShape& body, const Scene& scene) {
  const Eigen::Isometry3d world_from_robot = WorldFromRobot(scene);
  const auto wheel = [&](double side) {
    const double middle_m = side * body.track_m / 2.0, half_m = body.wheel_width_m / 2.0;
    return Cylinder(world_from_robot, Eigen::Vector3d::UnitY(), body.wheel_radius_m,
                    middle_m - half_m, middle_m + half_m);
  };
  const double bottom_m = body.chassis_bottom_m, top_m = bottom_m + body.chassis_height_m;
  RobotShape shape;
  shape.chassis =
      Cylinder(world_from_robot, Eigen::Vector3d::UnitZ(), body.chassis_radius_m, bottom_m, top_m);
  shape.left_wheel = wheel(1.0);
  shape.right_wheel = wheel(-1.0);
  shape.centre = world_from_robot.translation();
  shape.nose = world_from_robot * Eigen::Vector3d(kArrowReach * body.chassis_radius_m, 0.0, 0.0);
  return shape;
}

}  // namespace rift::view
