#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>
#include <vector>

#include "further_trials.hpp"
#include "rift/report/page/page.hpp"
#include "rift/sweep/explain/explanation.hpp"
#include "rift/sweep/explain/shrink.hpp"
#include "rift/sweep/falsify/evaluator.hpp"

namespace rift::commands {

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

/// Paths of a typical failure of each kind, for the page.
std::vector<report::TypicalFailure> TypicalFailures(const sweep::SweepResult& result,
                                                    const sweep::Explanation& explanation,
                                                    sweep::Evaluator& evaluator);

/// How a row of recorded logs is measured again: the flags of `rift gap` behind the two logs. Empty
/// for simulated candidates, whose rows `rift simulate --replay` drives again.
std::string GapFlags(const experiment::Experiment& experiment);

/// Does what costs further trials, and prints what it found unless `is_silent`. Shrinks a failure
/// into shrunk.json and the folder shrunk, whose table holds each trial that the claims rest on;
/// estimates a rare event into rare_event.json. False when it was told to stop.
/// Throws std::invalid_argument when there is no such row, or it does not fail.
bool SpendTrials(const std::filesystem::path& folder, const sweep::SweepResult& result,
                 const ExplainRequest& request, sweep::Evaluator& evaluator,
                 const FurtherTrials::Style& style, bool is_silent);

/// Draws the figures (SVG and PNG, in DIR/figures) and writes DIR/report.html. `sources` bring
/// the paths of the worst trial and of a typical failure of each kind again. Figures that make no
/// sense for this space are named on stderr.
void WriteSweepReport(const std::filesystem::path& folder, const sweep::SweepResult& result,
                      const sweep::Explanation& explanation, sweep::Evaluator& evaluator);

}  // namespace rift::commands
