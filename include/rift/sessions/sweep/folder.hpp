#pragma once

#include <filesystem>

#include "rift/experiment/experiment.hpp"
#include "rift/sweep/falsify/evaluator.hpp"

namespace rift::sessions {

/// The page of a sweep while it runs (LivePage).
inline constexpr const char* kLivePageName = "live.html";

/// The experiment that a sweep saved in its folder. Throws as experiment::LoadExperiment does.
experiment::Experiment SavedExperiment(const std::filesystem::path& folder);

/// True where the folder holds what another experiment made. A sweep that has a journal goes on
/// with it, which says by itself what differs; without one, only the same experiment may be written
/// once more.
bool HoldsOtherExperiment(const std::filesystem::path& folder,
                          const experiment::Experiment& experiment);

/// In a folder without an experiment or a journal the first file of a name that a sweep or a fit
/// writes or removes, such as table.csv or figures/fig08_gap_by_trial.svg: it is somebody else's.
/// Empty where there is none.
std::filesystem::path OthersFile(const std::filesystem::path& folder);

/// Figures of an earlier sweep or fit, and their folder where nothing else is in it.
void RemoveFigures(const std::filesystem::path& folder);

/// An earlier run's report beside a table without a gap would tell of other trials.
void RemoveReport(const std::filesystem::path& folder);

/// All that a sweep or a fit found, for one that starts over: until it ends nothing tells of
/// another experiment. Drives of the robot, and the suggestions that they were made from, are left
/// alone.
void RemoveFindings(const std::filesystem::path& folder);

/// What was run, what it read, table and summary.
void SaveResult(const std::filesystem::path& folder, const sweep::Evaluator& evaluator,
                const sweep::SweepResult& result);

}  // namespace rift::sessions
