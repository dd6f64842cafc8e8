#pragma once

#include <cstdint>
#include <string>

#include "rift/experiment/experiment.hpp"
#include "rift/sweep/falsify/grid.hpp"
#include "rift/sweep/falsify/simulated_trial.hpp"

namespace rift::commands {

/// The trial that an experiment describes. Throws std::invalid_argument, naming `experiment_file`,
/// when its waypoints make no task, or a heightfield image cannot be read.
sweep::SimulatedTrial TrialOf(const experiment::Experiment& experiment,
                              const geometry::Pose2& start, std::uint64_t seed,
                              const std::string& experiment_file);

/// Where a robot stood whose tag was seen at the start of a log, `tag_offset_m` ahead of it.
geometry::Pose2 StartFromLog(const trajectory::Trajectory& log, double tag_offset_m,
                             const simulation::MocapOptions& mocap);

/// A finished run as a sweep takes it: its log, or why it is no trajectory to be compared.
sweep::Recording RecordingOf(sweep::SimulatedRun run, std::uint64_t seed);

}  // namespace rift::commands
