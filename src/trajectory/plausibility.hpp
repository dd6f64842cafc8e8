#pragma once

#include <string>
#include <vector>

#include "rift/trajectory/log.hpp"

namespace rift::trajectory {

/// Throws std::invalid_argument `name:line: ...` for a position or a time that no robot logs;
/// `lines` holds the line of each pose. Without the limit their squares overflow.
void CheckMagnitudes(const Trajectory& trajectory, const std::vector<int>& lines,
                     const std::string& name);

/// Adds a note when the angles look like those of another dialect. Expects them as they stand in
/// the file, not yet converted.
void NoteDoubtfulAngles(Log& log);

}  // namespace rift::trajectory
