#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>
#include <vector>

#include "rift/experiment/experiment.hpp"
#include "rift/sweep/falsify/recorded_logs.hpp"

namespace rift::commands {

/// The experiment in a file, with `overrides` (`a.b=c`) on top. Throws as LoadExperiment does.
experiment::Experiment ReadExperiment(const std::filesystem::path& file,
                                      const std::vector<std::string>& overrides = {});

/// `name`, or, where there is no such file and rift is installed, the file of that name among those
/// that came with it (PREFIX/share/rift): configs/waypoints/paper.yaml works in any folder.
std::string FindInput(const std::string& name);

/// Throws std::invalid_argument, naming the file, when the experiment has neither waypoints nor a
/// program, as a robot's file has not, and shows how to give it some.
void RequireWaypoints(const experiment::Experiment& experiment, const std::string& file);
/// The same when the experiment is nothing to drive for another reason.
void RequireTask(const experiment::Experiment& experiment, const std::string& file);

/// Says once that the simulated robot does not stand level, and what would make it.
void WarnOfTilt(const experiment::Experiment& experiment);

/// Waypoints that no run can reach: throws std::invalid_argument, naming file and waypoint, for one
/// outside trial.arena, and for a path so long and so far out that its metres must be millimetres
/// or centimetres.
void RequireReachableWaypoints(const experiment::Experiment& experiment, const std::string& file);

/// `--any-waypoints`: drive them all the same.
void AddAnyWaypointsFlag(CLI::App& app, bool& any_waypoints);

/// The experiment's tag. Where its surface is bumps, a ramp or a heightfield the tag is not held to
/// a flat floor (TagOptions::ground): `flat` becomes what the surface allows.
vision::TagOptions TagOn(const experiment::Experiment& experiment);

/// Files for computation, whose notes go to stderr.
sweep::Inputs FileInputs();

}  // namespace rift::commands
