#pragma once

#include <filesystem>
#include <functional>
#include <optional>

#include "rift/sessions/sweep/live_page.hpp"
#include "rift/sessions/sweep/observer.hpp"
#include "rift/sweep/falsify/evaluator.hpp"
#include "rift/sweep/run/journal.hpp"
#include "rift/sweep/run/slurm_options.hpp"

namespace rift::sessions {

/// How a sweep is run, none of which its results depend on.
struct SweepRunRequest {
  std::filesystem::path out;
  int jobs = 1;
  bool fresh = false;                            ///< forget an earlier journal
  LivePage* live = nullptr;                      ///< told of each trial, where there is one
  const sweep::SlurmOptions* cluster = nullptr;  ///< where trials are run, if not here
  std::function<void(sweep::Journal&)> tick = [](sweep::Journal&) {};  ///< at least every 0.1 s
};

/// Runs what the experiment asks for; simulated trials go through worker processes and the journal
/// in the folder. Nothing when it was stopped: the same call goes on.
std::optional<sweep::SweepResult> RunSweep(sweep::Evaluator& evaluator,
                                           const SweepRunRequest& request,
                                           const SweepObserver& observer);

}  // namespace rift::sessions
