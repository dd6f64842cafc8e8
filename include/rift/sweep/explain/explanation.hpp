#pragma once

#include <vector>

#include "rift/sweep/explain/anatomy.hpp"
#include "rift/sweep/explain/clusters.hpp"
#include "rift/sweep/explain/factorial.hpp"
#include "rift/sweep/explain/failing_region.hpp"
#include "rift/sweep/explain/failure_probability.hpp"
#include "rift/sweep/explain/inert.hpp"
#include "rift/sweep/explain/sensitivity.hpp"
#include "rift/sweep/explain/suggest.hpp"

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
