#pragma once

#include <span>
#include <string>
#include <vector>

#include "rift/experiment/experiment.hpp"
#include "rift/sweep/falsify/trial_runner.hpp"
#include "stop_signal.hpp"
#include "sweep_progress.hpp"
#include "rift/sweep/falsify/evaluator.hpp"

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

  FurtherTrials(SweepSources& sources, const experiment::Experiment& experiment, const Style& style,
                const StopSignal& stop);

  std::vector<sweep::TrialRow> Run(std::vector<sweep::TrialRequest> requests);

  /// Between these, what was run is shown as progress towards `most` trials.
  void Begin(int most);
  void End();

  const sweep::GridPlan& plan() const { return plan_; }

 private:
  sweep::GridPlan plan_;
  Style style_;
  std::optional<SweepProgress> progress_;
  sweep::TrialRunner runner_;
};

/// The experiment's own values of its space's parameters.
experiment::Theta NominalTheta(const experiment::Experiment& experiment);

/// Those of the gap's options that are not the defaults, as flags of `rift gap`.
std::string ChangedGapFlags(const gap::GapOptions& options);

}  // namespace rift::commands
