#pragma once

#include <nlohmann/json.hpp>

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "rift/report/figures/options.hpp"
#include "rift/report/page/page.hpp"
#include "rift/sweep/falsify/result.hpp"

namespace rift::report {

/// The trials that the filter of the page lets through: all, those with one value of a parameter,
/// or those of one setting. Every statistic of them is computed here, as that of all trials is.
struct PageView {
  std::string group;                               ///< "surface", "setting"; empty for all trials
  std::string label;                               ///< "ground"
  std::string query;                               ///< of its trials, see Piece; empty for all
  std::shared_ptr<const sweep::SweepResult> part;  ///< of these trials alone
  std::vector<int> rows;                           ///< their indices in the whole result
  std::vector<int> settings;                       ///< likewise
};

/// All trials first, which share the result; it must outlive them. Of a large sweep that is the
/// only one.
std::vector<PageView> PageViews(const sweep::SweepResult& result);

/// A chart of the page: a heading, one sentence, and a Vega specification with its data.
struct PageChart {
  std::string title;
  std::string sentence;
  nlohmann::json spec;
  /// What differs in the first data set for each view, an array for each of its entries in the
  /// order of `fields`. Empty: the chart does not follow the filter.
  nlohmann::json views = nlohmann::json::array();
  nlohmann::json fields = nlohmann::json::array();
};

/// Of a value or a parameter at a chart's axis; the tip of its marks has the whole.
inline constexpr std::size_t kMostLabelLetters = 32;

/// The Vega specification of that name, without data.
nlohmann::json Template(std::string_view name);
/// Sets a signal that a specification has.
void SetSignal(nlohmann::json& spec, std::string_view name, const nlohmann::json& value);
/// JSON has no NaN; null is what charts and tables understand as "not there".
nlohmann::json Value(double value);

/// How many trials have which gap.
PageChart GapHistogram(const sweep::SweepResult& result, const std::vector<PageView>& views);

/// Where it fails over the two parameters that matter most; a title of "" where there is nothing to
/// show.
PageChart FailureMap(const sweep::SweepResult& result, const sweep::FailingRegion& region,
                     const std::vector<PageView>& views);

/// The paths as page.js draws them: of the rows shown, the references and, for each view, the band
/// of the simulated paths, the worst, and which others are drawn.
nlohmann::json PagePaths(const sweep::SweepResult& result, const PageEvidence& evidence,
                         const std::vector<PageView>& views, const ReportOptions& options);

/// Words of the page and what they mean, those of the parameters included.
nlohmann::json Glossary(const sweep::SweepResult& result);

/// A table of the page as page.js reads it: {"columns", "rows", "marks"}, and what it holds.
struct PageTable {
  nlohmann::json data;
  std::string note;
};

PageTable SettingsTable(const sweep::SweepResult& result, const ReportOptions& options);
/// `gap_flags`: see PageEvidence.
PageTable TrialsTable(const sweep::SweepResult& result, const std::string& gap_flags,
                      const ReportOptions& options);
/// The rows of that table, the worst of many.
std::vector<const sweep::TrialRow*> RowsToShow(const sweep::SweepResult& result, int limit);

/// Figure 14 of the paper, and the slip of the wheels along the way.
std::vector<PageChart> ProgramCharts(const sweep::SweepResult& result,
                                     const std::vector<sweep::ProgramCell>& programs);

/// What the loss depends on and what the gap is made of.
std::vector<PageChart> WhyCharts(const sweep::Explanation& explanation);

}  // namespace rift::report
