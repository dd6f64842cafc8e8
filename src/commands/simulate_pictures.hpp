#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "rift/experiment/experiment.hpp"
#include "rift/report/figures/simulation_figure.hpp"
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

}  // namespace rift::commands
