#pragma once

#include <optional>
#include <vector>

#include "rift/sweep/calibrate/options.hpp"
#include "rift/sweep/falsify/simulated_trial.hpp"
#include "rift/trajectory/trajectory.hpp"

namespace rift::sweep {

/// What the robot did from one logged pose to a later one, and what the simulator says it would
/// have done, both seen from the first: predicted minus logged.
struct HorizonError {
  size_t from = 0;  ///< row of the log
  int frames = 1;
  double ahead_m = 0.0;
  double left_m = 0.0;
  double turned_rad = 0.0;
};

/// The simulated robot under the commands that the controller gave in the log: the one trial loop
/// sees the logged poses, at the times they arrived, and drives the simulated robot. So the state
/// of controller, radio and motors is rebuilt at every row, and nothing the simulated robot does
/// comes back to the controller: no error of the model can grow into chaos. Returns the path of the
/// tag on the clock of the log. Of a log that was put on frames the stamps as logged say when the
/// host acted, the frames what it saw. How long a turn of the host took, and with it how old its
/// poses are, each log tells itself. `began_s`: when on that clock its trial began, which a
/// program's powers count from; without it, at the first row, or as long before as a host that
/// stamps a pose when it is done with it takes for the first one. A log whose robot left more than
/// 0.2 s after the replay's is replayed with a connection that stands as much later.
trajectory::Trajectory Replay(const SimulatedTrial& trial, const trajectory::Trajectory& log,
                              std::optional<double> began_s = {});

/// Motions over 1 to most_frames frames from every row while the robot moved, in order of rows,
/// each the mean over even phases of the robot's listener (seeds trial.seed, trial.seed + 1 and so
/// on), weighted by how likely the log is with each: the robot had one phase for the whole drive.
/// `trial.start` is where the log stands. Throws std::invalid_argument on a log without yaw.
std::vector<HorizonError> ShortHorizonErrors(const SimulatedTrial& trial,
                                             const trajectory::Trajectory& log,
                                             const ShortHorizonOptions& options,
                                             std::optional<double> began_s = {});

/// How far the simulator drives ahead from frame to frame under the commands of a log, over how far
/// the log went: the median over the frames in which it went ahead, which starts, stops and a
/// listener's phase leave as it is. NaN of a log that did not move.
double WayRatio(const SimulatedTrial& trial, const trajectory::Trajectory& log,
                std::optional<double> began_s = {});

}  // namespace rift::sweep
