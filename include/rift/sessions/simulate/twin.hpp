#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "rift/experiment/experiment.hpp"
#include "rift/sweep/falsify/recorded_logs.hpp"
#include "rift/twin/twin.hpp"

namespace rift::sessions {

/// A twin to be run, its camera.yaml and experiment.yaml in its folder.
struct PreparedTwin {
  experiment::Experiment experiment;  ///< with the simulation as the twin is, for a repeat
  twin::TwinSetup setup;
  std::filesystem::path folder;

  std::filesystem::path Calibration() const { return folder / "camera.yaml"; }
};

/// Throws std::invalid_argument when a file of a twin's folder is an input, or is there and not to
/// be replaced.
void CheckTwinNames(const std::filesystem::path& folder,
                    const std::vector<std::filesystem::path>& inputs, bool force);

/// Writes the two files. Throws as sweep::SimulatedTrialOf and twin::OverheadCamera do.
PreparedTwin PrepareTwin(const experiment::Experiment& experiment,
                         const std::string& experiment_file, const std::filesystem::path& folder,
                         const sweep::Inputs& inputs);

/// Serves until the trial is over or `is_stopped`, and writes the rest of the run folder:
/// truth.csv, trajectory.csv (the tag's true path) and summary.json. `announce` is called once port
/// and camera can be opened.
twin::TwinRun ServeTwin(const PreparedTwin& prepared,
                        const std::function<void(const twin::TwinAddress&)>& announce,
                        const std::function<bool()>& is_stopped);

/// Where port, camera and calibration are, as one line of JSON.
std::string AddressJson(const PreparedTwin& prepared, const twin::TwinAddress& address);

/// How a run ended, in words.
std::string EndingOf(const twin::TwinRun& run);

}  // namespace rift::sessions
