#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "rift/sessions/sweep/observer.hpp"
#include "rift/sweep/falsify/evaluator.hpp"
#include "rift/sweep/falsify/trial_runner.hpp"
#include "rift/sweep/run/journal.hpp"

namespace rift::sessions {

/// Trials of a sweep beyond its own, in worker processes. They do not enter its table; its journal
/// keeps them apart (sweep::kBesideTable), so that the same command goes on with them.
class FurtherTrials {
 public:
  struct Stopped {};  ///< thrown by Run when the user asked for an end

  /// `tick` is called at least every 0.1 s while trials are run. All but `jobs` must outlive it.
  FurtherTrials(
      sweep::Evaluator& evaluator, int jobs, const SweepObserver& observer, const GoOn& go_on,
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
  const SweepObserver& observer_;
  std::unique_ptr<TrialProgress> progress_;
  Bring bring_;
  sweep::TrialRunner runner_;
};

}  // namespace rift::sessions
