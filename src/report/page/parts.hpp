#pragma once

#include <nlohmann/json.hpp>

#include <string>
#include <string_view>
#include <vector>

#include "rift/report/figures/options.hpp"
#include "rift/report/page/page.hpp"
#include "rift/sweep/falsify/result.hpp"

namespace rift::report {

/// A chart of the page: a heading, one sentence, and a Vega specification with its data.
struct PageChart {
  std::string title;
  std::string sentence;
  nlohmann::json spec;
};

/// The Vega specification of that name, without data.
nlohmann::json Template(std::string_view name);
/// Sets a signal that a specification has.
void SetSignal(nlohmann::json& spec, std::string_view name, const nlohmann::json& value);
/// JSON has no NaN; null is what charts and tables understand as "not there".
nlohmann::json Value(double value);

std::vector<PageChart> PageCharts(const sweep::SweepResult& result, const ReportOptions& options);

/// A table of the page as page.js reads it: {"columns", "rows", "marks"}, and what it holds.
struct PageTable {
  nlohmann::json data;
  std::string note;
};

PageTable SettingsTable(const sweep::SweepResult& result, const ReportOptions& options);
/// `gap_flags`: see PageEvidence.
PageTable TrialsTable(const sweep::SweepResult& result, const std::string& gap_flags,
                      const ReportOptions& options);

/// Figure 14 of the paper, and the slip of the wheels along the way.
std::vector<PageChart> ProgramCharts(const sweep::SweepResult& result,
                                     const std::vector<sweep::ProgramCell>& programs);

/// What matters, what the gap is made of, where it fails, and typical failures.
std::vector<PageChart> WhyCharts(const sweep::SweepResult& result,
                                 const sweep::Explanation& explanation,
                                 const std::vector<TypicalFailure>& failures);

}  // namespace rift::report
