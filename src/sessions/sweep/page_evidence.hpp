#pragma once

#include <functional>
#include <optional>
#include <string>

#include "rift/report/figures/figures.hpp"
#include "rift/report/page/page.hpp"
#include "rift/sweep/falsify/evaluator.hpp"

namespace rift::sessions {

/// The worst trial against what it was held against.
struct WorstPaths {
  report::ComparedPair pair;
  sweep::Recording reference;
};

/// The worst trial computed again, a program within the limits of its trials. Nothing when no trial
/// has a gap, and where it does not come out any more, as of a program that fails now and then:
/// `say` is told why.
std::optional<WorstPaths> WorstPair(const sweep::SweepResult& result, sweep::Evaluator& evaluator,
                                    const std::function<void(const std::string&)>& say);

/// What a page is made of beside the result, the figures left out: references of the paths and
/// waypoints. A reference that has to be run is that of the worst trial alone, where it is at hand;
/// else nullptr.
report::PageEvidence EvidenceFor(const sweep::SweepResult& result, sweep::Evaluator& evaluator,
                                 const sweep::Recording* worst_reference);

}  // namespace rift::sessions
