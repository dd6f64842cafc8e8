#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "live_page.hpp"
#include "progress.hpp"
#include "rift/sweep/falsify/evaluator.hpp"
#include "rift/sweep/run/journal.hpp"
#include "rift/sweep/run/slurm_options.hpp"

namespace rift::commands {

/// How a sweep is run, none of which its results depend on.
struct SweepRunRequest {
  std::filesystem::path out;
  int jobs = 1;
  bool fresh = false;  ///< forget an earlier journal
  ProgressStyle progress = ProgressStyle::kQuiet;
  LivePage* live = nullptr;                      ///< told of each trial, where there is one
  const sweep::SlurmOptions* cluster = nullptr;  ///< where trials are run, if not here
  std::function<void(sweep::Journal&)> tick = [](sweep::Journal&) {};  ///< at least every 0.1 s
};

inline constexpr const char* kJournalName = "journal.sqlite";

/// Whether trials are computed, and kept in a journal. Logs held against logs or a path are read
/// anew each time.
bool IsComputed(const experiment::Experiment& experiment);

/// What the rows of an experiment's journal are made from.
sweep::Facts FactsOf(const experiment::Experiment& experiment);

/// Cores that this process may use.
int CoresToUse();

/// Runs what the experiment asks for; simulated trials go through worker processes and the journal
/// in the folder. Nothing when it was stopped: the same call goes on.
std::optional<sweep::SweepResult> RunSweep(sweep::Evaluator& evaluator,
                                           const SweepRunRequest& request);

/// How far the sweep in a folder is: while it runs, when it was stopped or killed, or when it is
/// done. Throws std::invalid_argument when there is no journal of a sweep.
std::string SweepStatus(const std::filesystem::path& folder, bool json);

}  // namespace rift::commands
