#pragma once

#include <random>
#include <string>

#include "rift/geometry/pose2.hpp"
#include "rift/trajectory/trajectory.hpp"

namespace rift::test {

/// `rows` poses along +x at 1 m/s, evenly spaced.
trajectory::Trajectory StraightPath(double length_m, int rows);

/// A wandering path of `rows` poses, 10 mm apart on average.
trajectory::Trajectory RandomPath(std::mt19937_64& generator, int rows);

trajectory::Trajectory Moved(trajectory::Trajectory path, const geometry::Pose2& b_from_a);

/// The text of a log with a few bytes replaced, half of them by others that logs hold, and one text
/// in four cut short.
std::string Damaged(std::string text, std::mt19937_64& generator);

}  // namespace rift::test
