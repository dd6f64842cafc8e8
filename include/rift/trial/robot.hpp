#pragma once

#include <optional>
#include <string>

#include "rift/control/diff_drive.hpp"
#include "rift/geometry/pose2.hpp"

namespace rift::trial {

/// What motion capture saw: a pose and when the picture was taken.
struct PoseMeasurement {
  double captured_s = 0.0;  ///< on the clock of Sensed::now_s
  geometry::Pose2 world_from_robot;
  double z_m = 0.0;
  double roll_rad = 0.0;
  double pitch_rad = 0.0;
};

/// Everything a controller may know at one moment.
struct Sensed {
  double now_s = 0.0;                   ///< since the robot was made; never runs backwards
  std::optional<PoseMeasurement> pose;  ///< the newest that has arrived; none before the first
  std::optional<control::EncoderCounts> encoders;  ///< none where the robot sends none
  std::optional<std::string> fault;  ///< why this robot can no longer go on, in one line
  std::optional<std::string> fall;   ///< that it tipped over or fell, and where; simulated alone
};

/// A robot that a trial can drive; the simulated and the real one look the same from here.
class Robot {
 public:
  virtual ~Robot() = default;

  virtual Sensed Sense() = 0;
  /// Sends a power to both wheels; it takes effect when the robot's link lets it.
  virtual void Command(const control::WheelPower& power) = 0;
  /// Lets `dt_s` seconds pass: the simulator computes them, the hardware waits for them.
  virtual void Advance(double dt_s) = 0;
  /// Sends zero power by the fastest way there is. Safe to call at any time, any number of times.
  virtual void Stop() noexcept = 0;
};

}  // namespace rift::trial
