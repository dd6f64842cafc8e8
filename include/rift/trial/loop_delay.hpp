#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "rift/control/options.hpp"
#include "rift/control/waypoint.hpp"
#include "rift/trajectory/trajectory.hpp"
#include "rift/trial/trial.hpp"

namespace rift::trial {

struct LoopDelayOptions {
  double max_lag_s = 0.6;
  double lag_step_s = 0.01;
  double moved_m = 0.02;

  /// Calls field(key, member, [min, max,] help) for every member; min and max are inclusive.
  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    field("max_lag_s", self.max_lag_s, 0.0, 10.0, "lags from 0 to this are tried");
    field("lag_step_s", self.lag_step_s, 1e-4, 1.0, "distance between two lags tried");
    field("moved_m", self.moved_m, 0.0, 10.0,
          "the log counts from where the robot is this far from its start");
  }
};

/// How the yaw rate of a log answers the steering of its controller.
struct LoopDelay {
  double lag_s = -1.0;      ///< where the steering explains the yaw rate best; -1: nowhere
  double r2 = 0.0;          ///< share of the yaw rate's variance explained there
  double gain_rad_s = 0.0;  ///< yaw rate for each unit of power_right - power_left there
  double bias_rad_s = 0.0;  ///< yaw rate without steering there
  size_t intervals = 0;     ///< between logged poses, while the robot moved
  std::vector<double> lags_s;
  std::vector<double> r2_at_lag;  ///< 0 where more steering to the left turns the robot right
};

/// The delay from a logged pose to the motion its command caused, found without knowing the
/// command: the controller is run again over the logged poses, and its steering is held against
/// the yaw rate some time later (facts: 0.32 s on the authors' robot, 0 in their simulator).
/// `waypoints` and `navigator` are those of the log, v_min and v_max included. x, y and yaw must
/// agree on their sense of rotation; either sense will do.
/// Throws std::invalid_argument on a log without yaw or with fewer than 10 moving intervals.
LoopDelay EstimateLoopDelay(const trajectory::Trajectory& log,
                            const std::vector<control::Waypoint>& waypoints,
                            const control::NavigatorOptions& navigator,
                            const LoopDelayOptions& options = {});

/// The same of a run whose commands are known: from a command as it was sent to the motion it
/// caused. `sent` and the log are on one clock. Throws like EstimateLoopDelay.
LoopDelay EstimateCommandDelay(const trajectory::Trajectory& log, std::span<const SentCommand> sent,
                               const LoopDelayOptions& options = {});

}  // namespace rift::trial
