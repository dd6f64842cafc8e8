#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "rift/experiment/experiment.hpp"
#include "rift/odometry/calibration.hpp"
#include "rift/odometry/program_runs.hpp"

namespace rift::sessions {

/// A run with the encoders beside it, and the experiment that it was of.
struct LoadedRun {
  odometry::ProgramRun run;
  std::optional<experiment::Experiment> experiment;
  std::vector<std::filesystem::path> files;  ///< what it was read from, there or not
};

/// `name`: a run folder, or a log with encoders.csv beside it. `program`: the experiment that it
/// was of; empty: the one in its folder. Throws std::invalid_argument when there is nothing to hold
/// the log against.
LoadedRun LoadRun(const std::string& name, const std::string& program);

/// Holds camera, encoders and program of runs (at least one) together. With `calibration`, finds
/// wheel radii and track as well.
odometry::OdometryResult MeasureOdometry(
    const std::vector<LoadedRun>& runs, odometry::RunOptions options,
    const std::optional<odometry::CalibrationOptions>& calibration);

}  // namespace rift::sessions
