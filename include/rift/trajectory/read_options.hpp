#pragma once

#include <string>

#include "rift/trajectory/log.hpp"

namespace rift::trajectory {

/// How a log is read: in a dialect, or in columns and units of its own.
struct ReadOptions {
  Format format = Format::kAuto;
  /// Which column holds what: `t=time,x=pose_x,y=pose_y,yaw=theta:deg`. Quantities: t, x, y, z,
  /// roll, pitch, yaw, qx, qy, qz, qw (a quaternion), target_x, target_y; of these t, x and y are
  /// needed. A source is the name of a column, or its number from 1, with a unit behind a colon
  /// where it is not that of `units`; a minus before it turns its sign, and sources joined by a
  /// plus are added, each with its own sign (`t=sec+nanosec:ns`, `x=-a+b`, `x=a+-b`). Empty: by the
  /// dialect, or, with `units`, by a guess, which a note tells.
  std::string columns;
  /// `mm,ms,deg`: lengths m, cm, mm, km, in, ft; times s, ms, us, ns, min; angles rad, deg. What is
  /// not named is in m, s and rad. Where columns are guessed, a unit in a column's name comes
  /// first.
  std::string units;
  /// What messages write before the columns that they offer.
  std::string columns_flag = "--columns ";
  /// The path is one in space: every pose needs its height, motion along z counts, and what only a
  /// robot on a floor does (drive along its yaw, stand upright) is not looked for.
  bool in_space = false;
  /// What is told of this log alone writes so before columns, where columns_flag is of several
  /// logs. Empty: columns_flag.
  std::string own_columns_flag{};

  std::string OwnColumnsFlag() const;
  std::string OwnUnitsFlag() const;
};

/// Throws std::invalid_argument with one line for columns or units that break a rule.
void CheckColumns(const ReadOptions& options);

/// As ReadLog in log.hpp. A log in columns of its own is of Format::kRift once it is read.
Log ReadLog(std::string_view text, const std::string& name, const ReadOptions& options);

}  // namespace rift::trajectory
