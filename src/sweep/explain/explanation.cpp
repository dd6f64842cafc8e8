#include "rift/sweep/explain/explanation.hpp"

namespace rift::sweep {

Explanation Explain(const SweepResult& result, const ExplainOptions& options) {
  Explanation explanation;
  explanation.factors = AnalyseFactors(result);
  explanation.sensitivity = EstimateSensitivity(result);
  explanation.inert = FindInert(result, explanation.factors);
  explanation.anatomy = Dissect(result);
  explanation.clusters = ClusterFailures(result);
  explanation.region =
      MapFailures(result, MostInfluential(result, explanation.factors, explanation.sensitivity));
  explanation.probability = EstimateFailureProbability(result);
  explanation.suggestions = SuggestExperiments(result, options.suggest);
  return explanation;
}

}  // namespace rift::sweep
