#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "rift/sessions/sweep/observer.hpp"
#include "rift/sweep/explain/failure_probability.hpp"
#include "rift/sweep/explain/shrink.hpp"
#include "rift/sweep/falsify/evaluator.hpp"
#include "rift/sweep/run/slurm_options.hpp"

namespace rift::sessions {

/// What is asked of a finished sweep that costs trials beyond its own.
struct FurtherQuestions {
  std::string shrink;       ///< id of a row in table.csv, or "worst"; empty: none
  bool rare_event = false;  ///< how often a setting drawn evenly from the space fails

  bool Any() const { return !shrink.empty() || rare_event; }
  /// Throws std::invalid_argument when the experiment cannot meet them, before a trial is run.
  void Check(const experiment::Experiment& experiment) const;

  /// Calls field(key, member, [what the value is called,] help) for every member.
  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    field("shrink", self.shrink, "ROW|worst",
          "bring a failing row of table.csv down to the fewest and smallest changes from the "
          "experiment's own values that still fail, by further trials");
    field("rare_event", self.rare_event,
          "estimate a small failure probability over the space by further trials (subset "
          "simulation)");
  }
};

struct FurtherAnswers {
  std::optional<sweep::ShrunkRow> shrunk;
  std::optional<sweep::RareEvent> rare_event;
};

/// Where the trials are run.
struct FurtherRun {
  int jobs = 1;
  const sweep::SlurmOptions* cluster = nullptr;  ///< if not here
};

/// Runs the trials that the questions ask for, and writes what they tell. A failing row is shrunk
/// with the random numbers that it had: DIR/shrunk.json, and DIR/shrunk with the trials that its
/// claims rest on as a table (the row, what it shrank to, and that with each of its changes taken
/// back), for `rift simulate --replay`. A rare event goes into DIR/rare_event.json. Nothing when it
/// was told to stop: the same call goes on. Throws std::invalid_argument when there is no such row,
/// or it does not fail.
std::optional<FurtherAnswers> Answer(const FurtherQuestions& questions,
                                     const std::filesystem::path& folder,
                                     const sweep::SweepResult& result, sweep::Evaluator& evaluator,
                                     const FurtherRun& run, const SweepObserver& observer);

}  // namespace rift::sessions
