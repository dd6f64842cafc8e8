#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "rift/report/figures/options.hpp"
#include "rift/sweep/falsify/result.hpp"

namespace rift::report {

/// A chart of the page: a heading, one sentence, and a Vega specification with its data.
struct PageChart {
  std::string title;
  std::string sentence;
  nlohmann::json spec;
};

std::vector<PageChart> PageCharts(const sweep::SweepResult& result, const ReportOptions& options);

}  // namespace rift::report
