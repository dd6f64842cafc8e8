#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "plausibility.hpp"
#include "rift/trajectory/log.hpp"

namespace rift::trajectory {

/// The poses of a log, as they stand in the file, and what can be told of them while they pass: a
/// long log is not walked through again for each of these.
struct LogRows {
  /// Throws std::invalid_argument `name:line: ...` for a pose that no robot logs.
  void Add(const StampedPose& pose, const std::string& name, int line);

  Trajectory trajectory;
  LargestAngles largest_angles;
  bool time_rises = true;  ///< from each row to the next
  std::optional<int> first_line_without_yaw;
};

/// Reads the rows of a dialect, those of `head` and of the pieces after it; kAuto stands for the
/// authors' header. Throws std::invalid_argument `name:line: ...`.
LogRows ReadRows(std::string_view head, const TextPieces& pieces, const std::string& name,
                 Format format);

}  // namespace rift::trajectory
