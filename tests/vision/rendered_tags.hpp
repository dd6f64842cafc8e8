#pragma once

#include <Eigen/Geometry>
#include <numbers>
#include <random>
#include <vector>

#include "rift/vision/camera/camera_model.hpp"
#include "rift/vision/rendering/synthetic_camera.hpp"
#include "rift/vision/tracking/tag_detector.hpp"
#include "support/inputs/paper_camera.hpp"

namespace rift::test {

inline vision::RobotMotion RobotAt(double x_m, double y_m, double yaw_rad, double z_m = 0.03) {
  vision::RobotMotion robot;
  robot.world_from_tag.translation() = Eigen::Vector3d(x_m, y_m, z_m);
  robot.world_from_tag.linear() =
      Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  return robot;
}

/// Where the corners of the black square really are in the picture.
inline vision::TagCorners TrueCorners(const vision::CameraModel& camera,
                                      const vision::RobotMotion& robot, double size_m = 0.0475) {
  const Eigen::Isometry3d camera_from_tag =
      camera.world->world_from_camera.inverse() * robot.world_from_tag;
  const double h = 0.5 * size_m;
  std::vector<Eigen::Vector3d> points;
  for (const auto& [x, y] : {std::pair{-h, -h}, {h, -h}, {h, h}, {-h, h}}) {
    points.push_back(camera_from_tag * Eigen::Vector3d(x, y, 0.0));
  }
  const std::vector<Eigen::Vector2d> pixels = vision::PixelsFromPoints(camera, points);
  return {pixels[0], pixels[1], pixels[2], pixels[3]};
}

/// The tag with its white border lies this far inside the picture.
inline bool IsInPicture(const vision::CameraModel& camera, const vision::RobotMotion& robot,
                        double spare_px = 6.0) {
  for (const Eigen::Vector2d& corner : TrueCorners(camera, robot, 0.0475 * 10 / 8)) {
    if (corner.x() < spare_px || corner.y() < spare_px) return false;
    if (corner.x() > camera.width_px - 1 - spare_px) return false;
    if (corner.y() > camera.height_px - 1 - spare_px) return false;
  }
  return true;
}

/// All over the picture, every heading.
inline std::vector<vision::RobotMotion> RandomRobots(const vision::CameraModel& camera, int count,
                                                     double tilt_rad = 0.0) {
  std::mt19937_64 generator(7);
  std::uniform_real_distribution<double> x(-0.8, 0.8), y(-0.5, 0.6);
  std::uniform_real_distribution<double> angle(-std::numbers::pi, std::numbers::pi);
  std::vector<vision::RobotMotion> robots;
  while (static_cast<int>(robots.size()) < count) {
    vision::RobotMotion robot = RobotAt(x(generator), y(generator), angle(generator));
    const double towards = angle(generator);
    const Eigen::Vector3d axis(std::cos(towards), std::sin(towards), 0.0);
    robot.world_from_tag.linear() =
        Eigen::AngleAxisd(tilt_rad, axis) * robot.world_from_tag.linear();
    if (IsInPicture(camera, robot)) robots.push_back(robot);
  }
  return robots;
}

}  // namespace rift::test
