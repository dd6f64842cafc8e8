#pragma once

#include <string>

#include "rift/trajectory/log.hpp"

namespace rift::trajectory {

/// Throws std::invalid_argument `name:line: ...` for a position, an angle or a time that no robot
/// logs; without the limit their squares overflow.
void CheckMagnitudes(const StampedPose& pose, const std::string& name, int line);

/// Faster than that drives no robot whose paths are compared here.
inline constexpr double kFastest_m_s = 10.0;

/// How well the yaw agrees with the direction of travel: the mean of cos 2e over pieces of the
/// path, e the angle between them. 1: always along it, forwards or backwards; 0: nothing to do with
/// it; NaN: too little motion, or no yaw.
double TravelAgreement(const Trajectory& trajectory);

/// Adds a note when the angles look like those of another dialect. Expects them as they stand in
/// the file, not yet converted.
void NoteDoubtfulAngles(Log& log);

}  // namespace rift::trajectory
