#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "rift/experiment/experiment.hpp"
#include "rift/sweep/explain/failure_probability.hpp"
#include "rift/sweep/explain/shrink.hpp"
#include "rift/sweep/falsify/evaluator.hpp"
#include "rift/sweep/falsify/trial_runner.hpp"
#include "stop_signal.hpp"
#include "sweep_progress.hpp"

namespace rift::commands {

/// Trials of a sweep beyond its own, in worker processes; they enter neither its journal nor its
/// table.
class FurtherTrials {
 public:
  struct Stopped {};  ///< thrown by Run when the user asked for an end
  struct Style {
    int jobs = 1;
    ProgressStyle progress = ProgressStyle::kQuiet;
  };

  FurtherTrials(sweep::Evaluator& evaluator, const Style& style, const StopSignal& stop);

  std::vector<sweep::TrialRow> Run(std::vector<sweep::TrialRequest> requests);

  /// Between these, what was run is shown as progress towards `most` trials.
  void Begin(int most);
  void End();

 private:
  Style style_;
  std::optional<SweepProgress> progress_;
  sweep::TrialRunner runner_;
};

/// Shrinks a row of the sweep (its id, or "worst") with the random numbers that the row had. Writes
/// DIR/shrunk.json, and DIR/shrunk with the trials that its claims rest on as a table: the row,
/// what it shrank to, and that with each of its changes taken back, for `rift simulate --replay`.
/// Returns what a person wants to know. Throws std::invalid_argument when there is no such row, or
/// it does not fail.
std::string ShrinkInto(const std::filesystem::path& folder,
                       const experiment::Experiment& experiment, const sweep::SweepResult& result,
                       const std::string& row, const sweep::ShrinkOptions& options,
                       FurtherTrials& trials);

/// Estimates how often a setting drawn evenly from the space fails, where that is too seldom for
/// plain draws. A setting fails when any of its trials does. Writes DIR/rare_event.json and returns
/// what a person wants to know.
std::string RareEventInto(const std::filesystem::path& folder,
                          const experiment::Experiment& experiment,
                          const sweep::RareEventOptions& options, FurtherTrials& trials);

}  // namespace rift::commands
