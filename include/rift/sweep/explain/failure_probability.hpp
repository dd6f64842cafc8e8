#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "rift/experiment/experiment.hpp"
#include "rift/sweep/falsify/result.hpp"
#include "rift/sweep/falsify/trial_runner.hpp"

namespace rift::sweep {

/// How often a run fails at a setting drawn evenly from the space: from the first trial that tells
/// of each setting that was drawn so, and from no others.
struct FailureProbability {
  int draws = 0;
  int failures = 0;
  int untold = 0;  ///< draws of which no trial tells; not among `draws`
  double share = gap::kNotComputed;
  double low = 0.0;  ///< Clopper and Pearson 1934
  double high = 1.0;
  double confidence = 0.95;
  std::string sentence;
};

FailureProbability EstimateFailureProbability(const SweepResult& result);

struct RareEventOptions {
  int replicas = 8;
  int samples_per_level = 300;
  double level_share = 0.1;
  int most_levels = 10;
  double step = 2.0;

  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    field("replicas", self.replicas, 4, 10'000,
          "estimates that are independent of each other: how far they are apart is the error");
    field("samples_per_level", self.samples_per_level, 20, 1'000'000,
          "trials of each level of a replica; the error falls with their square root");
    field("level_share", self.level_share, 0.01, 0.5,
          "share of a level's samples that lie in the next one");
    field("most_levels", self.most_levels, 1, 50, "levels after which it gives up");
    field("step", self.step, 0.01, 10.0,
          "largest move of a coordinate, in standard deviations of the level's samples");
  }
};

/// A small failure probability.
struct RareEvent {
  double probability = gap::kNotComputed;  ///< NaN when not reached
  double low = 0.0;                        ///< 95 % interval, from the scatter of the replicas
  /// When not reached, what the probability is below with 95 % confidence: the larger of what the
  /// levels leave and the one-sided bound of Clopper and Pearson for the independent draws.
  double high = 1.0;
  double coefficient_of_variation = gap::kNotComputed;
  int levels = 0;  ///< of the replica with the most
  int evaluations = 0;
  bool is_reached = false;  ///< failures were found; else the probability is below `high`
  int untold = 0;  ///< of the evaluations; left out where draws are counted, else taken to hold
};

/// Robustness at each of some points of the unit cube: below or at zero it fails; NaN: nothing
/// tells. It may depend on chance, drawn anew for each point.
using UnitRobustness = std::function<std::vector<double>(const std::vector<std::vector<double>>&)>;

/// Subset simulation (Au and Beck 2001) over the unit cube: a chain of levels of falling
/// robustness, each reached with probability `level_share` from the one before. Needs some hundred
/// trials for each factor of ten, where plain sampling needs ten times as many. Replicas start from
/// draws of their own, and what one of them misses (a second region, a category) shows in their
/// scatter; where all of them find failures at once, their draws are counted (Clopper-Pearson).
/// Where half of the first replica's draws fail, it alone is counted: the event is not rare.
/// Replicas, and within a level the chains, go on side by side: each call of `robustness` has the
/// next point of all of them, some hundred as a rule.
RareEvent EstimateRareEvent(int dimensions, const UnitRobustness& robustness, std::uint64_t seed,
                            const RareEventOptions& options = {});

/// The same over the experiment's space: how often a run fails at a setting drawn evenly from it.
/// Every run has a noise seed of its own.
RareEvent EstimateRareEvent(const experiment::Experiment& experiment, const RunAllTrials& run,
                            const RareEventOptions& options);

}  // namespace rift::sweep
