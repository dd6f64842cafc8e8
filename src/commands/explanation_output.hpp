#pragma once

#include <string>

#include "rift/sweep/explain/explanation.hpp"

namespace rift::commands {

/// Everything of an explanation, rows by their id in table.csv: {effects, sobol, parameters (inert
/// and why), anatomy, failures, failing_region, failure_probability, undecided, suggestions}.
std::string ExplanationJson(const sweep::SweepResult& result,
                            const sweep::Explanation& explanation);

/// The first answers of it for the terminal; with `suggest` the next experiments as well.
std::string ExplanationText(const sweep::SweepResult& result, const sweep::Explanation& explanation,
                            bool suggest);

}  // namespace rift::commands
