#pragma once

#include <vector>

#include "rift/sweep/anatomy.hpp"
#include "rift/sweep/clusters.hpp"
#include "rift/sweep/factorial.hpp"
#include "rift/sweep/failing_region.hpp"
#include "rift/sweep/failure_probability.hpp"
#include "rift/sweep/inert.hpp"
#include "rift/sweep/sensitivity.hpp"
#include "rift/sweep/suggest.hpp"

namespace rift::sweep {

struct ExplainOptions {
  SuggestOptions suggest;
};

/// Everything that the rows of a sweep tell about why, how sure and what next. No trial is run.
struct Explanation {
  FactorialAnalysis factors;
  Sensitivity sensitivity;
  std::vector<Inertness> inert;
  Anatomy anatomy;
  std::vector<FailureCluster> clusters;
  FailingRegion region;
  FailureProbability probability;
  std::vector<Suggestion> suggestions;
};

Explanation Explain(const SweepResult& result, const ExplainOptions& options = {});

}  // namespace rift::sweep
