#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>

#include "rift/experiment/experiment.hpp"

namespace rift::commands {

/// What cannot be asked of a robot in real time is refused beside --twin.
void ExcludeFromTwin(CLI::App& app);

/// `simulate --twin`: serves until the trial is over or a signal comes, says in one line of JSON on
/// stdout where port, camera and calibration are, and writes the run folder: experiment.yaml (with
/// the simulation as the twin is, for `simulate` to repeat), camera.yaml, truth.csv, trajectory.csv
/// (the tag's true path) and summary.json.
int RunTwin(const std::string& experiment_file, const experiment::Experiment& experiment,
            const std::filesystem::path& folder);

}  // namespace rift::commands
