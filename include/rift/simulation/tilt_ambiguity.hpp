#pragma once

#include <Eigen/Geometry>

#include "rift/geometry/pose2.hpp"

namespace rift::simulation {

/// A flat tag that is small in the picture looks nearly the same in two poses: its own, and one
/// tilted as far to the other side of the line of sight (Schweighofer and Pinz, Robust pose
/// estimation from a planar target, 2006). A tracker that takes the wrong one now and then reports
/// another tilt, and with it another yaw.
struct AmbiguityOptions {
  double share = 0.0;
  double runs = 1.0;
  double x_m = 0.0;
  double y_m = 0.0;
  double reach_m = 0.1;
  double angle_rad = 0.35;
  double range_m = 0.0;
  double camera_x_m = 0.0;
  double camera_y_m = 0.0;
  double camera_z_m = 0.9;
  double nearer = 0.0;

  /// Calls field(key, member, [min, max,] help) for every member; min and max are inclusive.
  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    field("share", self.share, 0.0, 0.9,
          "share of the pictures of a tag at x_m, y_m in which its tilt is mirrored at the line of "
          "sight; a robot that stands draws its own, of this mean (logs on flat ground: 0.52)");
    field("runs", self.runs, 0.0, 1.0,
          "share of the runs in which that happens at all (logs on ground: 8 of 12, of other flat "
          "surfaces: all)");
    field(
        "x_m", self.x_m, -100.0, 100.0,
        "where in the camera's view that happens most often, in m (logs: -0.22, near their start)");
    field("y_m", self.y_m, -100.0, 100.0, "the same in y, in m (logs: -0.07)");
    field("reach_m", self.reach_m, 0.001, 100.0,
          "at this distance from there the share is 0.61 of that, further away it falls as a bell "
          "curve does, in m (logs: 0.08)");
    field("angle_rad", self.angle_rad, 0.0, 1.6,
          "between line of sight and the tag's normal in rad; beyond it nothing is mirrored (logs: "
          "0.28 is)");
    field("range_m", self.range_m, 0.0, 100.0,
          "nearer to the camera than this a tag is large in the picture and nothing is mirrored, "
          "in m "
          "(logs: 0.9 is, 0.7 on the downhill board is not)");
    field("camera_x_m", self.camera_x_m, -100.0, 100.0,
          "x of the camera in m (logs: -0.04, from the pairs of tilts)");
    field("camera_y_m", self.camera_y_m, -100.0, 100.0, "y of the camera in m (logs: 0)");
    field("camera_z_m", self.camera_z_m, 0.01, 100.0,
          "height of the camera above the floor in m (z of the logs on flat ground: 0.88)");
    field("nearer", self.nearer, 0.0, 0.1,
          "how much nearer to the camera the mirrored pose is, as a share of the distance (logs: "
          "0.005)");
  }
};

/// The share of the pictures in which a tag there is taken for its mirrored pose; z of the tag is
/// its normal, in m.
double MirroredShare(const AmbiguityOptions& options, const Eigen::Isometry3d& world_from_tag);

/// The other pose of which the picture, seen from far, is that of the tag.
Eigen::Isometry3d Mirrored(const AmbiguityOptions& options,
                           const Eigen::Isometry3d& world_from_tag);

/// Where a level tag lies that is seen at `mirrored`, a pose in the floor's plane, because it is
/// taken for its mirrored pose: world_from_tag. As it was seen where no tag is mirrored. `above_m`:
/// of the tag over the floor.
geometry::Pose2 LevelTag(const AmbiguityOptions& options, const geometry::Pose2& mirrored,
                         double above_m);

}  // namespace rift::simulation
