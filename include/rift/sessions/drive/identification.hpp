#pragma once

#include "rift/experiment/experiment.hpp"

namespace rift::sessions {

/// How often the program of an identification is driven unless --repeat says it.
constexpr int kIdentificationRuns = 5;

/// The experiment with a program in place of its waypoints that tells what waypoint drives cannot:
/// steps of power and coasting forwards and backwards, spins and arcs to both sides, which takes a
/// 3pi+ half a minute, within 0.5 m of the first waypoint (of the origin without one).
experiment::Experiment IdentificationDrive(experiment::Experiment experiment);

/// `logs`, a sweep over the logs of such drives, as a fit of the simulated robot to them. What the
/// experiment fits already stays; without, it is what these drives identify, in ranges about its
/// robot's values.
experiment::Experiment IdentificationFit(experiment::Experiment logs);

}  // namespace rift::sessions
