#pragma once

#include <Eigen/Geometry>
#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "rift/trajectory/trajectory.hpp"

namespace rift::trajectory {

/// The CSV dialects. They differ in their units and frames, not only in their names:
///   rift     t_s,x_m,y_m,z_m,roll_rad,pitch_rad,yaw_rad,target_x_m,target_y_m[,more_columns]
///   tum      evo's: no header, blanks between t tx ty tz qx qy qz qw, `#` starts a comment
///   tracker  the authors' real logs: t,x,y,z,roll,pitch,yaw,desired_x,desired_y in the camera
///            frame (y down, z away from the camera), angles in degrees
///   webots   the authors' simulator: the same header, radians, yaw turned by +pi/2
/// `auto` tells them by their header. The header of tracker and webots is the same, so their
/// positions are read and their angles stay unknown until the dialect is named.
enum class Format { kAuto, kRift, kTum, kTracker, kWebots };

constexpr std::array<std::string_view, 5> EnumNames(Format) {
  return {"auto", "rift", "tum", "tracker", "webots"};
}

/// A log as it was read.
struct Log {
  Trajectory trajectory;
  Format format = Format::kAuto;   ///< kAuto: the authors' header, which of the two is not known
  std::vector<std::string> notes;  ///< what was mended or looks odd, one line each
  /// Why it may have been read in wrong units, frames or columns, one line each: Doubts().
  std::vector<std::string> doubts;
  /// Why the angles are unknown and what to do; empty when they are known or not logged.
  std::string unknown_angles;
  /// The first line of the file without a yaw when others have one; else nothing.
  std::optional<int> line_without_yaw;
};

/// Reads a whole log or throws std::invalid_argument with one line `name:row: what is wrong`.
/// Rows whose column track_state is not 0 (rift track: predicted, ambiguous, lost) are left out and
/// noted; a log of several tag_id is refused.
/// Rows out of order are sorted by time and of rows with equal time the last is kept, both noted.
/// Refused: NaN or infinite values, |x|, |y| or |z| above 1e6 m, |t| above 1e12 s, angles above 1e6
/// (degrees or radians), ragged rows, two columns of one name, fewer than two poses, a path of zero
/// length.
/// Noted: degrees where the dialect has radians, and the other way round.
/// Accepted: a byte order mark, CRLF, blank lines, header cells in double quotes, `+1.0`, empty
/// cells in optional columns (not logged).
Log ReadLog(std::string_view text, const std::string& name, Format format = Format::kAuto);

/// How a person names the unit of a log, for the doubts that ask for one.
struct UnitAdvice {
  std::string length = "--units mm";
  std::string time = "--units ms";
};

/// What no robot on wheels logs, each with the mistake that makes a log look so: speeds above 10
/// m/s, a path of a few millimetres, poses seconds apart, rows that are each there twice, a robot
/// that lies on its side, a yaw that has nothing to do with the direction of travel (degrees for
/// radians, a mirrored axis, swapped axes, a wrong column).
/// In space (ReadOptions::in_space) neither tilt nor yaw is doubted, and distances hold z.
std::vector<std::string> Doubts(const Trajectory& trajectory, bool in_space = false,
                                const UnitAdvice& advice = {});

/// The rift dialect; doubles in the shortest form that reads back to the same bits, values that
/// are not logged as empty cells.
std::string WriteRift(const Trajectory& trajectory);

/// One row of it with its line end; `channels` has a value for each channel.
std::string RiftRow(const StampedPose& pose, std::span<const double> channels);

/// Rotation of the body in the world: roll about x, then pitch about y, then yaw about z. Angles
/// that are not logged count as zero.
Eigen::Quaterniond WorldFromBody(const StampedPose& pose);

/// evo's TUM dialect; angles and heights that are not logged are written as zero.
std::string WriteTum(const Trajectory& trajectory);

/// A file for Foxglove and PlotJuggler (mcap.dev): topics /pose and /target
/// (foxglove.PoseInFrame in frame "world", metres) and /signals (rift.Signals, one number for each
/// channel, null where not logged), as JSON; log times are t_s in nanoseconds, counted from the
/// first row where that is below zero. Throws std::invalid_argument beyond 9e9 s.
std::string WriteMcap(const Trajectory& trajectory);

}  // namespace rift::trajectory
