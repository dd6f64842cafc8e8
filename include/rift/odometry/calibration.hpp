#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "rift/odometry/odometry.hpp"
#include "rift/statistics/descriptive.hpp"
#include "rift/statistics/inference.hpp"
#include "rift/trajectory/trajectory.hpp"

namespace rift::odometry {

/// A run as the camera and the wheels saw it, on one clock.
struct RunLog {
  std::string name;
  trajectory::Trajectory camera;  ///< rows without a yaw count in no odometry
  std::vector<EncoderReading> encoders;
};

struct CalibrationOptions {
  double window_s = 3.0;     ///< runs are cut into pieces of this length, each one observation
  double confidence = 0.95;  ///< of the intervals
};

struct Estimate {
  double value = 0.0;
  statistics::Interval interval;
  /// False where the runs hardly tell it: without turns there is no track.
  bool is_told = false;
};

/// Wheels and track that explain what the camera saw.
struct OdometryCalibration {
  Estimate wheel_radius_m;   ///< mean of both
  Estimate right_over_left;  ///< of the radii
  Estimate track_m;
  Estimate tag_ahead_m;  ///< centre of the tag ahead of the axle
  double noise_m = 0.0;  ///< RMS of what is left, of each coordinate
  double noise_yaw_rad = 0.0;
  std::size_t runs = 0;
  std::size_t windows = 0;

  OdometryOptions Applied(OdometryOptions options) const;
};

/// Least squares over windows of the runs: in each the odometry path is laid on the camera's poses
/// by a start of its own, and radii, track and the place of the tag are common. Poses that are off
/// by more than four sigma count less (Huber). The intervals are those of a jackknife over windows
/// with Student's t, so that noise within a window may be of any kind.
/// Throws std::invalid_argument when there are fewer than eight windows in which a wheel turned.
OdometryCalibration CalibrateOdometry(std::span<const RunLog> runs, const OdometryOptions& start,
                                      const CalibrationOptions& options = {});

/// UMBmark (Borenstein and Feng 1996): where the odometry of closed runs ends, seen from where the
/// camera saw them end, in the frame of their start. The mean of the runs of one direction is their
/// systematic error.
struct Umbmark {
  std::size_t ccw_runs = 0;
  std::size_t cw_runs = 0;
  Eigen::Vector2d ccw_m = Eigen::Vector2d::Zero();
  Eigen::Vector2d cw_m = Eigen::Vector2d::Zero();
  double largest_m = 0.0;  ///< the larger of the two distances, E_max,syst
};

/// None unless there are runs of both directions; those that turn by less than half a turn count
/// for neither. The camera's point is `tag_ahead_m` ahead of the axle.
std::optional<Umbmark> UmbmarkOf(std::span<const RunLog> runs, const OdometryOptions& options,
                                 double tag_ahead_m = 0.0);

/// The rows of the camera that have a yaw, without channels. Throws std::invalid_argument
/// `name: ...` for none.
trajectory::Trajectory WithYaw(const RunLog& run);

/// The place and heading in which the odometry of a run begins: where the camera saw it stand, or,
/// when it had left by the first reading, where the camera saw it then. Of rows with a yaw; throws
/// as WithYaw.
geometry::Pose2 OdometryStart(const RunLog& run);

/// Where the camera saw it at the last moment that camera and wheels share.
geometry::Pose2 OdometryEnd(const RunLog& run);

}  // namespace rift::odometry
