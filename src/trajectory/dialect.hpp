#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "rift/trajectory/log.hpp"

namespace rift::trajectory {

/// The dialect that the header tells; kAuto where it is the authors', which is the same for their
/// robot and their simulator. Throws std::invalid_argument `name:line: ...` when it is of none; the
/// message offers a guess at its columns behind `columns_flag`.
Format FormatFromHeader(std::string_view text, const std::string& name,
                        const std::string& columns_flag);

/// Throws std::invalid_argument when the header tells another dialect than `format`.
void RequireFormat(std::string_view text, const std::string& name, Format format);

/// The poses of a log as they stand in the file, in the units and the frame of its dialect.
struct LogRows {
  Trajectory trajectory;
  std::optional<int> first_line_without_yaw;
  size_t untracked = 0;  ///< rows that say themselves that their pose was not measured for certain
  size_t without_position = 0;  ///< rows of a log in columns of its own that hold no pose
  std::string guessed;          ///< the columns, where they were guessed: as ReadOptions::columns
};

/// By the column track_state: rift track marks what it has not measured for certain. 0 is tracked,
/// all else is predicted, ambiguous or lost.
bool IsTracked(double track_state);

/// A log of several robots has their rows among each other. Throws std::invalid_argument for tag_id
/// of more than one value; NaN is none.
void RequireOneRobot(std::vector<double> tags, const std::string& name);

/// Adds a pose, checked by CheckMagnitudes().
void AddPose(LogRows& rows, const StampedPose& pose, const std::string& name, int line);

/// kAuto stands for the authors' header. Throws std::invalid_argument `name:line: ...`; for a
/// column of text that is none of the dialect's it says how `columns_flag` reads past it.
LogRows ReadRows(std::string_view text, const std::string& name, Format format,
                 const std::string& columns_flag);

/// Brings the poses from the units and the frame of their dialect to those of StampedPose. Angles
/// and heights of a log in kAuto are taken out, and unknown_angles says why.
void ConvertUnitsAndFrame(Log& log);

}  // namespace rift::trajectory
