#pragma once

#include <optional>
#include <string>

#include "rift/trial/robot.hpp"

namespace rift::hardware {

/// A pose and the way it came; all times on the Clock.
struct PoseSample {
  trial::PoseMeasurement measured;  ///< world_from_robot, captured_s
  double arrived_s = 0.0;           ///< when the picture was in memory
  double ready_s = 0.0;             ///< when the tag had been found in it
};

struct PoseNews {
  std::optional<PoseSample> newest;  ///< none before the first
  std::optional<double> looked_s;    ///< capture time of the newest picture, tag or no tag
  /// Capture time of the first of the newest pictures that are all the same; none when the newest
  /// differs from the one before.
  std::optional<double> repeats_since_s;
  std::optional<std::string> fault;  ///< why no more pictures will come, in one line
};

/// Whoever knows where the robot is: a camera's tracker, or a test.
class PoseSource {
 public:
  virtual ~PoseSource() = default;
  /// Without waiting. May be called from another thread than the one that made it.
  virtual PoseNews Newest() = 0;
};

}  // namespace rift::hardware
