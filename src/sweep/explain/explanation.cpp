#include "rift/sweep/explain/explanation.hpp"

namespace rift::sweep {

Explanation Explain(const SweepResult& result, const ExplainOptions& options) {
  Explanation explanation;
  explanation.effects = MeasureEffects(result);
  explanation.inert = FindInert(result, explanation.effects);
  explanation.anatomy = Dissect(result);
  explanation.clusters = ClusterFailures(result);
  explanation.region = MapFailures(result, MostInfluential(result, explanation.effects));
  explanation.probability = EstimateFailureProbability(result);
  explanation.robot = options.robot;
  explanation.suggestions = SuggestExperiments(result, options.suggest, options.robot);
  return explanation;
}

}  // namespace rift::sweep
