#pragma once

#include <filesystem>

#include "drive_run.hpp"

namespace rift::commands {

/// Writes the run folder of a drive: what a simulated run's has (trajectory.csv, commands.csv,
/// experiment.yaml, summary.json), and stages.csv in place of the true path.
void SaveDrive(const std::filesystem::path& folder, const config::Experiment& experiment,
               const DriveRun& run);

}  // namespace rift::commands
