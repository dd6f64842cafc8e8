#pragma once

#include <string>

#include "rift/trajectory/log.hpp"

namespace rift::trajectory {

/// Throws std::invalid_argument `name:line: ...` for a position, an angle or a time that no robot
/// logs; without the limit their squares overflow.
void CheckMagnitudes(const StampedPose& pose, const std::string& name, int line);

/// Adds a note when the angles look like those of another dialect. Expects them as they stand in
/// the file, not yet converted.
void NoteDoubtfulAngles(Log& log);

}  // namespace rift::trajectory
