#pragma once

#include <vector>

#include "rift/control/waypoint.hpp"
#include "rift/sweep/falsify/recorded_logs.hpp"
#include "rift/sweep/falsify/simulated_trial.hpp"

namespace rift::sweep {

/// How a trial ended, as a row of a sweep says it.
TrialStatus StatusOf(trial::Outcome outcome);

/// From where a log, of one row at least, ends to the last waypoint, along the path through those
/// that it did not reach. One is reached where the log, straight between its rows, comes near
/// enough to it after it did to the one before.
double WayLeft_m(const trajectory::Trajectory& log, const std::vector<control::Waypoint>& waypoints,
                 double reach_radius_m);

/// A finished run as a sweep takes it: its log, its stamps put back on frames of `grid_fps` (0:
/// left as they are), or why it is no trajectory to be compared.
Recording RecordingOf(SimulatedRun run, const SimulatedTrial& trial, double grid_fps = 0.0);

}  // namespace rift::sweep
