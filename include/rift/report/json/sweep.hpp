#pragma once

#include <string>

#include "rift/sweep/explain/explanation.hpp"
#include "rift/sweep/explain/failure_probability.hpp"
#include "rift/sweep/explain/shrink.hpp"
#include "rift/sweep/falsify/result.hpp"

namespace rift::report {

/// summary.json: {mean_gap_m, failures, n, not_ok, "by": {parameter: {value: the same}}, effects,
/// settings, ...}
std::string SummaryJson(const sweep::SweepResult& result);

/// explanation.json, rows by their id in table.csv: {effects, sobol, parameters (inert and why),
/// anatomy, failures, failing_region, failure_probability, undecided, suggestions}.
std::string ExplanationJson(const sweep::SweepResult& result,
                            const sweep::Explanation& explanation);

/// shrunk.json: the failing row, what it shrank to, and its changes taken back one by one.
/// `folder` holds the table of these trials, for `rift simulate --replay`.
std::string ShrunkJson(const sweep::SweepResult& result, const sweep::ShrunkRow& shrunk,
                       const std::string& folder);

/// rare_event.json.
std::string RareEventJson(const sweep::RareEvent& event, const sweep::RareEventOptions& options,
                          size_t trials_per_setting);

}  // namespace rift::report
