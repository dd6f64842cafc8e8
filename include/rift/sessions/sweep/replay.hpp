#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "rift/experiment/experiment.hpp"
#include "rift/sweep/falsify/recorded_logs.hpp"
#include "rift/sweep/falsify/simulated_trial.hpp"

namespace rift::sessions {

/// A row of a sweep's table made again.
struct Replay {
  experiment::Experiment experiment;  ///< at the setting and with the seed of the row
  sweep::SimulatedTrial trial;
  sweep::SimulatedRun run;
  std::string verdict;  ///< one line: that the row came out the same
};

/// A row of a program's sweep made again.
struct ProgramReplay {
  experiment::Experiment experiment;
  trajectory::Trajectory trajectory;  ///< empty where the run wrote none
  bool has_arrived = false;
  std::string verdict;
};

/// Nothing when the candidates of that sweep are no runs of a program; else as ReplayRow.
std::optional<ProgramReplay> ReplayProgramRow(const std::filesystem::path& folder,
                                              const std::string& id, const sweep::Inputs& inputs);

/// Simulates the trial of row `id` in the folder of a sweep again and holds it against the table.
/// Throws std::invalid_argument when the folder holds no such row or its candidates are logs, and
/// std::runtime_error when the row comes out different: another version made it.
Replay ReplayRow(const std::filesystem::path& folder, const std::string& id,
                 const sweep::Inputs& inputs);

}  // namespace rift::sessions
