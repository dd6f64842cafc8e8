#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "rift/report/figures/options.hpp"
#include "rift/sweep/falsify/result.hpp"

namespace rift::report {

/// A table of the page as page.js reads it: {"columns", "rows", "marks"}, and what it holds.
struct PageTable {
  nlohmann::json data;
  std::string note;
};

PageTable SettingsTable(const sweep::SweepResult& result, const ReportOptions& options);
/// `gap_flags`: see PageEvidence.
PageTable TrialsTable(const sweep::SweepResult& result, const std::string& gap_flags,
                      const ReportOptions& options);

}  // namespace rift::report
