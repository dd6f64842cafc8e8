#pragma once

#include <vector>

#include "charts.hpp"
#include "rift/report/page/page.hpp"

namespace rift::report {

/// What matters, what the gap is made of, where it fails, and typical failures.
std::vector<PageChart> WhyCharts(const sweep::SweepResult& result,
                                 const sweep::Explanation& explanation,
                                 const std::vector<TypicalFailure>& failures);

}  // namespace rift::report
