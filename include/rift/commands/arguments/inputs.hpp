#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>
#include <vector>

#include "rift/experiment/task.hpp"
#include "rift/sweep/falsify/recorded_logs.hpp"

namespace rift::commands {

/// The experiment in a file, with `overrides` (`a.b=c`) on top. Throws as LoadExperiment does.
experiment::Experiment ReadExperiment(const std::filesystem::path& file,
                                      const std::vector<std::string>& overrides = {});

/// `name`, or, where there is no such file and rift is installed, the file of that name among those
/// that came with it (PREFIX/share/rift): configs/waypoints/paper.yaml works in any folder.
std::string FindInput(const std::string& name);

/// Says once that the simulated robot does not stand level, and what would make it.
void WarnOfTilt(const experiment::Experiment& experiment);

/// `--any-waypoints`: drive them all the same.
void AddAnyWaypointsFlag(CLI::App& app, bool& any_waypoints);

/// Files for computation, whose notes go to stderr.
sweep::Inputs FileInputs();

}  // namespace rift::commands
