#pragma once

#include <vector>

#include "rift/odometry/odometry.hpp"
#include "rift/trajectory/trajectory.hpp"

namespace rift::odometry {

/// What the wheels did while the camera logged, from the first moment that both saw to the last: a
/// drive's readings begin before its log, with the turn that measures the camera's latency and what
/// a hand did. At both ends the counts between two readings, rounded. Fewer than two readings where
/// they share no time.
std::vector<EncoderReading> ReadingsDuring(const trajectory::Trajectory& log,
                                           const std::vector<EncoderReading>& readings);

}  // namespace rift::odometry
