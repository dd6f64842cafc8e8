#pragma once

#include <string>

#include "rift/trajectory/trajectory.hpp"

namespace rift::trajectory {

/// What the frames of a camera explain of a log. NaN: not computed.
struct FrameGrid {
  bool is_found = false;  ///< false: the stamps stay as they were logged
  bool is_best = false;   ///< grids of rates 10 % off explain less
  double period_s = StampedPose::kNotLogged;
  /// Robust scatter of the second difference of the speed from row to row, over the median speed:
  /// with the stamps as logged, and with those of the grid.
  double roughness_before = StampedPose::kNotLogged;
  double roughness_after = StampedPose::kNotLogged;
  double outside_share = StampedPose::kNotLogged;  ///< rows that are not of the newest frame

  double Smoother() const { return roughness_before / roughness_after; }
  /// One line for people: what was done, or why nothing was.
  std::string Text() const;
};

/// A log whose time stamps stand on the frames of a camera of about `fps` frames a second.
///
/// A loop that takes a frame a turn and stamps the pose turns later sees frames 33 and 67 ms apart
/// at stamps that are 60 ms apart: speeds from row to row jump by a factor of two. Here each row
/// gets the frame that makes the speeds change least, from those within about a frame of its stamp
/// (Viterbi over the rows; period within 0.2 % and phase by search), as if all poses were equally
/// old. The mean of all stamps stays: a constant delay cannot be seen. Each pose keeps its stamp
/// as logged in stamp_s: that is when the loop acted.
///
/// Nothing is changed unless the speeds become smoother by `kLeastSmoother`, since a grid that is
/// not there makes them rougher, and unless grids of rates 10 % off explain less; nor for fewer
/// than 12 rows in motion, more than 100 s, or more rows and frames than seconds suffice for (6000
/// of each in 100 s do). Throws std::invalid_argument unless fps lies in [1, 1000].
struct OnFrames {
  Trajectory trajectory;
  FrameGrid grid;
};
OnFrames PutOnFrames(Trajectory log, double fps);

/// The same without the evidence; 0 frames a second leave the log as it is.
Trajectory OnFramesOf(Trajectory log, double fps);

inline constexpr double kLeastSmoother = 1.5;

}  // namespace rift::trajectory
