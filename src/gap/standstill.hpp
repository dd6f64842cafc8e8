#pragma once

#include <span>

#include "rift/trajectory/trajectory.hpp"

namespace rift::gap {

/// The rows in which the robot drives: from the last one near the first point to the first one
/// that stays near the last point. The whole log when it never leaves that radius.
struct MovingRange {
  size_t first = 0;
  size_t last = 0;
};

MovingRange FindMoving(std::span<const trajectory::StampedPose> poses, double radius_m);

/// Arc length that was logged outside that range: jitter of a standing robot.
double StandingLength_m(std::span<const trajectory::StampedPose> poses, double radius_m);

}  // namespace rift::gap
