#pragma once

#include <CLI/CLI.hpp>

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "engine.hpp"
#include "progress.hpp"
#include "rift/experiment/experiment.hpp"
#include "rift/sweep/explain/explanation.hpp"
#include "rift/sweep/explain/failure_probability.hpp"
#include "rift/sweep/explain/shrink.hpp"
#include "rift/sweep/falsify/evaluator.hpp"
#include "rift/sweep/falsify/trial_runner.hpp"
#include "rift/terminal/stop_signal.hpp"

namespace rift::commands {

/// Trials of a sweep beyond its own, in worker processes. They do not enter its table; its journal
/// keeps them apart (sweep::kBesideTable), so that the same command goes on with them.
class FurtherTrials {
 public:
  struct Stopped {};  ///< thrown by Run when the user asked for an end
  struct Style {
    int jobs = 1;
    ProgressStyle progress = ProgressStyle::kQuiet;
    const sweep::SlurmOptions* cluster = nullptr;  ///< where trials are run, if not here
  };

  /// `tick` is called at least every 0.1 s while trials are run. All but the style must outlive it.
  FurtherTrials(
      sweep::Evaluator& evaluator, const Style& style, const terminal::StopSignal& stop,
      sweep::Journal& journal, std::function<void(sweep::Journal&)> tick = [](sweep::Journal&) {});

  std::vector<sweep::TrialRow> Run(std::vector<sweep::TrialRequest> requests);
  /// The same for what computes with them; must not outlive this.
  sweep::RunAllTrials AsRun() {
    return [this](std::vector<sweep::TrialRequest> requests) { return Run(std::move(requests)); };
  }

  /// Brings further trials into the journal, from elsewhere; false when it was told to stop.
  using Bring = std::function<bool()>;
  /// The next trials that the journal lacks are asked for there, once, before they are run here.
  void AskFor(Bring bring) { bring_ = std::move(bring); }

  /// Between these, what was run is shown as progress towards `most` trials.
  void Begin(int most);
  void End();

 private:
  Style style_;
  std::optional<SweepProgress> progress_;
  Bring bring_;
  sweep::TrialRunner runner_;
};

/// Runs the trials that shrinking a row, known by its request, asks for: what the jobs of a cluster
/// do. Throws FurtherTrials::Stopped.
void RunTrialsOfShrinking(const experiment::Experiment& experiment, const sweep::TrialRequest& row,
                          const sweep::ShrinkOptions& options, FurtherTrials& trials);

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

/// What of a sweep's explanation is asked for on the command line.
struct ExplainRequest {
  int suggest = 0;     ///< experiments to print; 0: none
  std::string shrink;  ///< id of a row in table.csv, or "worst"; empty: none
  bool rare_event = false;
  sweep::ExplainOptions options;
  sweep::ShrinkOptions shrink_options;
  sweep::RareEventOptions rare_event_options;
};

void AddExplainFlags(CLI::App& app, ExplainRequest& request);

/// Throws std::invalid_argument when a request cannot be met, before a trial is run.
void CheckRequest(const ExplainRequest& request, const experiment::Experiment& experiment);

/// The options with what the command line says on top.
sweep::ExplainOptions OptionsFor(const ExplainRequest& request);

/// Does what costs further trials, and prints what it found unless `is_silent`. Shrinks a failure
/// into shrunk.json and the folder shrunk, whose table holds each trial that the claims rest on;
/// estimates a rare event into rare_event.json. False when it was told to stop.
/// Throws std::invalid_argument when there is no such row, or it does not fail.
bool SpendTrials(const std::filesystem::path& folder, const sweep::SweepResult& result,
                 const ExplainRequest& request, sweep::Evaluator& evaluator,
                 const FurtherTrials::Style& style, bool is_silent);

}  // namespace rift::commands
