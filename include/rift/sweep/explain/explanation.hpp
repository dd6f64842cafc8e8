#pragma once

#include <vector>

#include "rift/sweep/explain/anatomy.hpp"
#include "rift/sweep/explain/clusters.hpp"
#include "rift/sweep/explain/effects.hpp"
#include "rift/sweep/explain/failing_region.hpp"
#include "rift/sweep/explain/failure_probability.hpp"
#include "rift/sweep/explain/inert.hpp"
#include "rift/sweep/explain/suggest.hpp"

namespace rift::sweep {

struct ExplainOptions {
  SuggestOptions suggest;
  std::vector<RobotTrials> robot;  ///< of earlier suggestions, one entry each
};

/// Everything that the rows of a sweep tell about why, how sure and what next. No trial is run.
struct Explanation {
  Effects effects;
  std::vector<Inertness> inert;
  Anatomy anatomy;
  std::vector<FailureCluster> clusters;
  FailingRegion region;
  FailureProbability probability;
  std::vector<RobotTrials> robot;  ///< of earlier suggestions
  Suggestions suggestions;
};

Explanation Explain(const SweepResult& result, const ExplainOptions& options = {});

}  // namespace rift::sweep
