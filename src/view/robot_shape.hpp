#pragma once

#include <Eigen/Core>
#include <vector>

#include "rift/view/scene.hpp"

namespace rift::view {

/// Points in the world frame whose hulls are the robot, from whatever side it is seen.
struct RobotShape {
  std::vector<Eigen::Vector3d> chassis;
  std::vector<Eigen::Vector3d> left_wheel;
  std::vector<Eigen::Vector3d> right_wheel;
  Eigen::Vector3d centre;
  Eigen::Vector3d nose;  ///< tip of the heading arrow
};

RobotShape ShapeOf(const BodyShape& body, const Scene& scene);

}  // namespace rift::view
