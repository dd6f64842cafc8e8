#pragma once

#include <filesystem>
#include <vector>

#include "rift/sessions/sweep/suggested.hpp"
#include "rift/sweep/explain/explanation.hpp"
#include "rift/sweep/falsify/evaluator.hpp"

namespace rift::sessions {

/// The drives that `rift drive --suggested` saved in the folder of a sweep, judged as the sweep's
/// own trials are: one entry for each suggested experiment with a drive. Throws what ReadSuggested
/// and Evaluator::EvaluateDriven do.
std::vector<sweep::RobotTrials> TakeRobotLogs(const std::filesystem::path& sweep,
                                              sweep::Evaluator& evaluator);

/// Writes suggested.yaml: the experiments that have drives keep their numbers, new ones follow. A
/// suggestion for a setting that was driven asks for further trials of it. False, and nothing is
/// written, for sweeps over recorded logs: their parameters are no keys of an experiment.
bool SaveSuggested(const std::filesystem::path& sweep, const experiment::Experiment& experiment,
                   const sweep::SweepResult& result, const sweep::Suggestions& suggestions);

}  // namespace rift::sessions
