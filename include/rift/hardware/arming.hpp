#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "rift/control/options.hpp"
#include "rift/control/waypoint.hpp"
#include "rift/hardware/byte_line.hpp"
#include "rift/hardware/ping.hpp"
#include "rift/hardware/pose_source.hpp"
#include "rift/hardware/real_robot.hpp"
#include "rift/trial/trial.hpp"

namespace rift::hardware {

/// What the robot is to do, and within which limits.
struct DriveTask {
  std::vector<control::Waypoint> waypoints;
  control::NavigatorOptions control;
  trial::TrialOptions trial;
  HardwareOptions hardware;
};

/// What a drive is made of and whom it talks to.
struct DriveParts {
  ByteLine& line;
  PoseSource& poses;
  Clock& clock;
  /// Asked many times a second: a key, a signal.
  std::vector<Stopper> stoppers;
  /// One line for the operator.
  std::function<void(const std::string&)> say;
  /// Asked until it is true: may the robot move now?
  std::function<bool()> may_arm;
  bool threads = true;  ///< false where `clock` is no real one
};

struct DriveRun {
  bool has_begun = false;  ///< false: a person stopped it before the start
  PingResult ping;
  trial::TrialResult trial;
  DriveRecord evidence;
  double stopping_distance_m = 0.0;
};

/// Hello, ping, stopping distance, the first pose, the operator's yes, the trial, the stop.
/// Throws std::runtime_error when the drive cannot begin (link over its budget, robot not seen,
/// camera or port gone); std::invalid_argument for waypoints that are no task.
DriveRun Drive(const DriveParts& parts, const DriveTask& task);

/// The link alone: hello and ping, with the motors at zero.
PingResult MeasureLink(ByteLine& line, Clock& clock, const HardwareOptions& options);

}  // namespace rift::hardware
