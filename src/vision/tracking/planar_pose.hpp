#pragma once

#include <Eigen/Geometry>
#include <vector>

namespace rift::vision {

/// camera_from_plane for a camera that sees points of the plane z = 0 along these rays: the two
/// local minima of IPPE [Collins and Bartoli 2014] as OpenCV finds them, the better first. Four
/// points or more, not on a line; none where OpenCV finds no pose.
std::vector<Eigen::Isometry3d> PlanarPoses(const std::vector<Eigen::Vector2d>& in_plane_m,
                                           const std::vector<Eigen::Vector2d>& rays);

}  // namespace rift::vision
