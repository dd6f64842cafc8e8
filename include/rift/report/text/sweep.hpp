#pragma once

#include <string>

#include "rift/sweep/explain/explanation.hpp"
#include "rift/sweep/explain/failure_probability.hpp"
#include "rift/sweep/explain/shrink.hpp"
#include "rift/sweep/falsify/result.hpp"

namespace rift::report {

/// What a person wants to know of a sweep first.
std::string SweepText(const sweep::SweepResult& result);

/// Because of what and how sure; with `suggest` the next experiments as well.
std::string ExplanationText(const sweep::SweepResult& result, const sweep::Explanation& explanation,
                            bool suggest);

/// What a failing row was shrunk to; `folder` holds the table of its trials.
std::string ShrunkText(const sweep::SweepResult& result, const sweep::ShrunkRow& found,
                       const std::string& folder);

/// The command that drives row `row` (from 0) of the table in `folder` again.
std::string ReplayCommand(const std::string& folder, size_t row);

std::string RareEventSentence(const sweep::RareEvent& event);

}  // namespace rift::report
