#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "rift/hardware/options.hpp"
#include "rift/hardware/real_robot.hpp"
#include "rift/odometry/odometry.hpp"

namespace rift::hardware {

/// An angle at a time; it runs on through +-pi.
struct Angle {
  double t_s = 0.0;
  double rad = 0.0;
};

/// Appends an angle that is known up to whole turns.
void AddAngle(std::vector<Angle>& angles, double t_s, double rad);

/// How one angle follows another: `follower(t) = scale * leader(t - lag) + offset`.
struct Lag {
  double lag_s = 0.0;
  double scale = 0.0;
  double residual_rad = 0.0;  ///< RMS
};

/// By least squares over all lags from `least_s` to `most_s`. Times rise. None when either angle
/// stands still or has too few samples.
std::optional<Lag> EstimateLag(std::span<const Angle> follower, std::span<const Angle> leader,
                               double least_s, double most_s);

/// Where the time between a turn of the robot and a command that answers it goes. Unset: not known
/// by this link.
struct LoopDelay {
  std::optional<double> camera_s;  ///< from the light to the picture's time stamp
  std::optional<double> host_s;    ///< from the stamp to the command on the line
  std::optional<double> link_s;    ///< half of the median round trip
  std::optional<double> robot_s;   ///< from the command's arrival to wheels that obey
  /// From a command to its effect in an arriving pose, all parts together: control.latency.delay_s.
  std::optional<double> total_s;
  /// Where the wheels tell nothing of the camera alone: it is no later than this.
  std::optional<double> camera_most_s = std::nullopt;
};

/// What the turn before a drive told.
struct LatencyResult {
  LoopDelay delay;
  double turned_deg = 0.0;  ///< of the wheels, to one side
  double seen_deg = 0.0;    ///< by the camera
};

/// The turn of the robot as its encoders count it: right minus left.
std::vector<Angle> WheelTurns(std::span<const EncoderReading> readings, double rad_per_count);

/// Whether they are read often enough to time anything: a plain line is answered five times a
/// second, and nothing says how late.
bool AreTimed(std::span<const Angle> wheels);

/// Turns an armed robot on the spot, a few degrees to and fro, and finds how late the camera is.
/// None when somebody stopped it. Throws std::runtime_error, with what was measured, when the
/// picture does not show the turn, shows it to the other side or before the wheels made it, or not
/// clearly when.
std::optional<LatencyResult> MeasureLatency(RealRobot& robot,
                                            const odometry::OdometryOptions& odometry,
                                            const TurnOptions& options, double one_way_s);

}  // namespace rift::hardware
