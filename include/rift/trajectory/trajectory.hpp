#pragma once

#include <Eigen/Core>
#include <cmath>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "rift/geometry/pose2.hpp"

namespace rift::trajectory {

/// One logged pose. World frame: y up (logs of the authors' tracker: down), z up, metres; radians.
/// A value that the log does not hold is NaN; t_s, x_m and y_m are always finite.
struct StampedPose {
  static constexpr double kNotLogged = std::numeric_limits<double>::quiet_NaN();

  double t_s = 0.0;
  double x_m = 0.0;
  double y_m = 0.0;
  double z_m = kNotLogged;
  double roll_rad = kNotLogged;
  double pitch_rad = kNotLogged;
  double yaw_rad = kNotLogged;
  double target_x_m = kNotLogged;  ///< the waypoint the controller drove to at this moment
  double target_y_m = kNotLogged;
  double stamp_s = kNotLogged;  ///< as logged, where t_s was moved to a frame (PutOnFrames)

  /// The time stamp of the log, whatever t_s was moved to.
  double Stamp_s() const { return std::isnan(stamp_s) ? t_s : stamp_s; }

  Eigen::Vector2d Position() const { return {x_m, y_m}; }
  Eigen::Vector3d PositionInSpace() const { return {x_m, y_m, z_m}; }
  geometry::Pose2 Planar() const { return {x_m, y_m, yaw_rad}; }
};

/// A further column of a log, one value for each pose. Its name ends in its unit (`_m`, `_rad_s`)
/// or has none (a power, a count).
struct Channel {
  std::string name;
  std::vector<double> values;
};

/// Poses in order of strictly increasing time, at least two of them once read from a log.
struct Trajectory {
  std::vector<StampedPose> poses;
  std::vector<Channel> channels;

  bool HasYaw() const;
  double Duration_s() const;
  double ArcLength_m() const;
};

/// Length of the polyline through the planar positions.
double ArcLength_m(std::span<const StampedPose> poses);

/// The same trajectory seen from a point `offset_m` further forward on the body: the authors log
/// the centre of the tag, their Webots the axle, which the published gaps take 0.03 m ahead of it.
/// Throws std::invalid_argument when the offset is not zero and the yaw is not known.
Trajectory OffsetAlongHeading(Trajectory trajectory, double offset_m);

/// A robot that is seen further than this from where it stood, or turned by more, has left.
inline constexpr double kStandingRadius_m = 0.01, kStandingTurn_rad = 0.1;

/// Where the robot stood before it drove: the median over the first rows within `radius_m` of the
/// first one, since a tracker's first poses jump. A tracker that takes a flat tag for its mirrored
/// pose (Schweighofer and Pinz 2006) sees it tilted further and turned: of two tilts the lower one
/// counts. Throws std::invalid_argument without a yaw.
geometry::Pose2 StandingPose(const Trajectory& trajectory, double radius_m = kStandingRadius_m);

/// Angle between the tag's normal and the vertical where the robot stood: the median over the rows
/// of StandingPose; NaN where it is not logged. The log has a yaw.
double StandingTilt_rad(const Trajectory& trajectory, double radius_m = kStandingRadius_m);

}  // namespace rift::trajectory
