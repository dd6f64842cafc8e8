#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "rift/commands/arguments/log_copies.hpp"
#include "rift/experiment/experiment.hpp"
#include "rift/report/figures/figures.hpp"
#include "rift/sweep/falsify/simulated_trial.hpp"

namespace rift::commands {

/// What a person wants to see of a simulated run.
struct PictureRequest {
  std::string figure;  ///< FILE.svg or FILE.png; empty: none
  std::string video;   ///< FILE.mp4; empty: none
  bool window = false;
};

/// Adds --figure, --video and --view.
void AddPictureFlags(CLI::App& app, PictureRequest& request);

/// Throws std::invalid_argument for names that say no format.
void CheckPictureNames(const PictureRequest& request);

/// Rectangles of the floor with their own friction.
std::vector<geometry::FloorArea> AreasOf(const simulation::TerrainOptions& terrain);

/// Draws path, heights, speed and powers into `path`.
void DrawFigure(const std::string& path, const experiment::Experiment& experiment,
                const sweep::SimulatedTrial& trial, const sweep::SimulatedRun& run);

/// What `rift simulate` was asked for.
struct SimulateRequest {
  std::string experiment;
  std::vector<std::string> overrides;
  std::string start;
  std::string seed;
  std::string out;
  LogCopies copies;
  std::vector<std::string> replay;  ///< folder of a sweep and id of a row
  bool json = false;
  bool twin = false;
  bool force = false;
  bool any_waypoints = false;
  PictureRequest pictures;
};

/// A simulated run and what it was made from.
struct Simulated {
  std::filesystem::path out;
  experiment::Experiment experiment;
  sweep::SimulatedTrial trial;
  sweep::SimulatedRun run;
};

/// Simulates, or replays, and saves the run; then calls `show`, if there is one, and prints the
/// summary. Returns the exit code.
int Simulate(const SimulateRequest& request, const std::function<void(const Simulated&)>& show);

/// The experiment of `simulate --twin` and the folder for it. Throws std::invalid_argument when
/// there is none, or when the folder's files would replace an input.
struct TwinJob {
  experiment::Experiment experiment;
  std::filesystem::path folder;
};
TwinJob LoadTwinJob(const SimulateRequest& request);

}  // namespace rift::commands
