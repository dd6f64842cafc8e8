#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <optional>
#include <string>

#include "rift/report/page.hpp"
#include "rift/sweep/explanation.hpp"
#include "rift/sweep/shrink.hpp"
#include "sweep_sources.hpp"

namespace rift::commands {

/// What of a sweep's explanation is asked for on the command line.
struct ExplainRequest {
  int suggest = 0;             ///< experiments to print; 0: none
  std::string shrink;          ///< number of a row in table.csv, or "worst"; empty: none
  bool rare_event = false;
  sweep::ExplainOptions options;
  sweep::ShrinkOptions shrink_options;
  sweep::RareEventOptions rare_event_options;
};

void AddExplainFlags(CLI::App& app, ExplainRequest& request);

/// Throws std::invalid_argument when a request cannot be met, before a trial is run.
void CheckRequest(const ExplainRequest& request, const config::Experiment& experiment);

/// The words of the explanation for the terminal.
std::string ExplanationText(const sweep::Explanation& explanation, const ExplainRequest& request);

/// Paths of a typical failure of each kind, for the page.
std::vector<report::TypicalFailure> TypicalFailures(const sweep::SweepResult& result,
                                                    const sweep::Explanation& explanation,
                                                    SweepSources& sources);

/// Does what costs further trials: shrinks a failure into shrunk.json, estimates a rare event into
/// rare_event.json; prints both.
void SpendTrials(const std::filesystem::path& folder, const config::Experiment& experiment,
                 const sweep::SweepResult& result, const ExplainRequest& request,
                 SweepSources& sources);

}  // namespace rift::commands
