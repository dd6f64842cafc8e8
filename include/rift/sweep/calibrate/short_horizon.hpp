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
/// tag on the clock of the log. `began_s`: when on that clock its trial began, which a program's
/// powers count from; without it, at the first row.
trajectory::Trajectory Replay(const SimulatedTrial& trial, const trajectory::Trajectory& log,
                              std::optional<double> began_s = {});

/// Motions over 1 to most_frames frames from every row while the robot moved, in order of rows,
/// each the mean over even phases of the robot's listener (seeds trial.seed, trial.seed + 1 and so
/// on). `trial.start` is where the log stands. Throws std::invalid_argument on a log without yaw.
std::vector<HorizonError> ShortHorizonErrors(const SimulatedTrial& trial,
                                             const trajectory::Trajectory& log,
                                             const ShortHorizonOptions& options,
                                             std::optional<double> began_s = {});

}  // namespace rift::sweep
