#pragma once

#include <cstdint>
#include <memory>
#include <string_view>
#include <vector>

#include "rift/experiment/experiment.hpp"
#include "rift/odometry/odometry.hpp"
#include "rift/simulation/simulated_robot.hpp"
#include "rift/sweep/falsify/recorded_logs.hpp"
#include "rift/trial/trial.hpp"

namespace rift::sweep {

/// Everything one simulated trial depends on.
struct SimulatedTrial {
  control::Task task;
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
  /// The wheels at each decision, on that clock; none where the robot does not report them.
  std::vector<odometry::EncoderReading> encoders;
};

/// The trial that an experiment describes. Throws std::invalid_argument, naming `experiment_file`,
/// when it describes no task, or a heightfield image cannot be read.
SimulatedTrial SimulatedTrialOf(const experiment::Experiment& experiment,
                                const geometry::Pose2& start, std::uint64_t seed,
                                const std::string& experiment_file, const Inputs& inputs);

/// What a robot would do that keeps to its task exactly: Task::IdealPath as a trajectory.
trajectory::Trajectory IdealPath(const control::Task& task);

/// Where a robot stood whose tag was seen at the start of a log, `tag_offset_m` ahead of it:
/// world_from_robot. Where every row that stands is tilted as no ground is, and the simulated
/// tracker takes tags there for their mirrored poses, what that does to a pose is taken back.
geometry::Pose2 StartFromLog(const trajectory::Trajectory& log, double tag_offset_m,
                             const simulation::MocapOptions& mocap);

/// Runs the one trial loop on the simulated robot. The same trial gives the same bytes.
/// Throws std::invalid_argument for options or waypoints that break a rule.
SimulatedRun Simulate(const SimulatedTrial& trial);

/// Fingerprint of the sources of everything that a simulated trial runs through: rows of an older
/// one may be other rows today.
std::string_view PhysicsVersion();

}  // namespace rift::sweep
