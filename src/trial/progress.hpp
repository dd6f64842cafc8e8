#pragma once

#include <vector>

#include "rift/control/waypoint.hpp"
#include "rift/trajectory/trajectory.hpp"
#include "rift/trial/trial.hpp"

namespace rift::trial {

/// Way by strides of 0.2 s, which noise hardly lengthens while the robot drives; of one that stands
/// it is noise alone.
double Way_m(const trajectory::Trajectory& log);

/// Of the straight lines between the waypoints.
double Length_m(const std::vector<control::Waypoint>& waypoints);

/// How far a run came with its task, by where it was and not by the way it drove.
struct Progress {
  double took_s = 0.0;
  double left_m = 0.0;       ///< of the task, at the end
  double last_s = 0.0;       ///< last third of the run, which the following are of
  double moved_m = 0.0;      ///< extent of nine tenths of its positions
  double turned_rad = 0.0;   ///< extent of nine tenths of its yaws
  double nearing_mps = 0.0;  ///< by which `left_m` fell; of the whole run where that is less

  bool IsStanding() const;
  bool IsNearing() const;
};

/// Of a run with two poses at least.
Progress ProgressOf(const TrialResult& result, const std::vector<control::Waypoint>& waypoints);

}  // namespace rift::trial
