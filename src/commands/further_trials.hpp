#pragma once

#include <span>
#include <string>
#include <vector>

#include "rift/experiment/experiment.hpp"
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

/// Those of the gap's options that are not the defaults, as flags of `rift gap`.
std::string ChangedGapFlags(const gap::GapOptions& options);

}  // namespace rift::commands
