#pragma once

#include <string>

#include "rift/trajectory/log.hpp"

namespace rift::trajectory {

/// Throws std::invalid_argument `name:line: ...` for a position, an angle or a time that no robot
/// logs.
/// Without the limit their squares overflow.
void CheckMagnitudes(const StampedPose& pose, const std::string& name, int line);

/// Largest absolute values that are logged; zero without any.
struct LargestAngles {
  void Add(const StampedPose& pose);

  double roll_rad = 0.0, pitch_rad = 0.0, yaw_rad = 0.0;
};

/// Adds a note when the angles look like those of another dialect. Expects them as they stand in
/// the file, not yet converted.
void NoteDoubtfulAngles(Log& log, const LargestAngles& largest);

}  // namespace rift::trajectory
