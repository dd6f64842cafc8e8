#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "rift/trajectory/log.hpp"

namespace rift::trajectory {

/// The poses of a log, as they stand in the file, and the line of each.
struct LogRows {
  Trajectory trajectory;
  std::vector<int> lines;
};

/// Reads the rows of a dialect, those of `head` and of the pieces after it; kAuto stands for the
/// authors' header. Throws std::invalid_argument `name:line: ...`.
LogRows ReadRows(std::string_view head, const TextPieces& pieces, const std::string& name,
                 Format format);

}  // namespace rift::trajectory
