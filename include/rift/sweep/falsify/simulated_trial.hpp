#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "rift/control/options.hpp"
#include "rift/control/waypoint.hpp"
#include "rift/simulation/simulated_robot.hpp"
#include "rift/trial/trial.hpp"

namespace rift::sweep {

/// Everything one simulated trial depends on.
struct SimulatedTrial {
  std::vector<control::Waypoint> waypoints;
  control::NavigatorOptions control;
  trial::TrialOptions trial;
  simulation::SimulationOptions simulation;
  geometry::Pose2 start;  ///< world_from_robot, middle of the axle
  std::uint64_t seed = 1;
  std::shared_ptr<const simulation::HeightImage> image;  ///< of a heightfield surface
};

struct SimulatedRun {
  trial::TrialResult result;
  /// Where the robot really was after each control period, on the clock of the log.
  trajectory::Trajectory truth;
};

/// Runs the one trial loop on the simulated robot. The same trial gives the same bytes.
/// Throws std::invalid_argument for options or waypoints that break a rule.
SimulatedRun Simulate(const SimulatedTrial& trial);

}  // namespace rift::sweep
