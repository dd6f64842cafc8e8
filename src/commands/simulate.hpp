#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "rift/experiment/experiment.hpp"
#include "rift/sweep/falsify/simulated_trial.hpp"
#include "simulate_pictures.hpp"

namespace rift::commands {

/// What `rift simulate` was asked for.
struct SimulateRequest {
  std::string experiment;
  std::vector<std::string> overrides;
  std::string start;
  std::string seed;
  std::string out;
  std::string tum;
  std::vector<std::string> replay;  ///< folder of a sweep and id of a row
  bool json = false;
  bool twin = false;
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
