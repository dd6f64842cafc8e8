#pragma once

#include <string>

#include "rift/report/options.hpp"
#include "rift/sweep/result.hpp"

namespace rift::report {

/// The report of a sweep as one HTML page that needs nothing else: no network, no second file.
/// First screen: the findings in words. Then charts (Vega), then tables that sort.
std::string RenderPage(const sweep::SweepResult& result, const ReportOptions& options = {});

}  // namespace rift::report
