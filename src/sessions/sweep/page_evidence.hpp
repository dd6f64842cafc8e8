#pragma once

#include <optional>
#include <string>

#include "rift/report/figures/figures.hpp"
#include "rift/report/page/page.hpp"
#include "rift/sweep/falsify/evaluator.hpp"

namespace rift::sessions {

/// The worst trial and what it was held against, computed again; nothing when no trial has a gap.
/// Throws std::runtime_error when it does not come out any more.
std::optional<report::ComparedPair> WorstPair(const sweep::SweepResult& result,
                                              sweep::Evaluator& evaluator);

/// What a page is made of beside the result, the figures left out: references of the paths and
/// waypoints. With `may_compute` also the reference of the worst trial where it has to be run.
report::PageEvidence EvidenceFor(const sweep::SweepResult& result, sweep::Evaluator& evaluator,
                                 bool may_compute);

}  // namespace rift::sessions
