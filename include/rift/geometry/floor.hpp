#pragma once

#include <Eigen/Core>
#include <string>

namespace rift::geometry {

/// A waypoint, or another place on the floor, as pictures of it name it.
struct NamedPoint {
  std::string name;
  Eigen::Vector2d p_in_world_m;
};

/// A rectangle of the floor that is not like the rest: a slope, a block, a patch with its own
/// friction. No label: drawn without one.
struct FloorArea {
  std::string label;
  double x_min_m = 0.0;
  double x_max_m = 0.0;
  double y_min_m = 0.0;
  double y_max_m = 0.0;
};

}  // namespace rift::geometry
