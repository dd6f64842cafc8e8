#pragma once

#include <string>

#include <vector>

#include "rift/report/figures/figures.hpp"
#include "rift/report/figures/options.hpp"
#include "rift/sweep/explain/explanation.hpp"
#include "rift/sweep/explain/program_cells.hpp"
#include "rift/sweep/falsify/result.hpp"

namespace rift::report {

/// The report of a sweep as one HTML page that needs nothing else: no network, no second file.
/// First screen: the findings in words; their numbers lead to their rows, and each row shows the
/// command that drives it again. Then charts (Vega), then tables that sort.
std::string RenderPage(const sweep::SweepResult& result, const ReportOptions& options = {});

/// The paths of a typical failure of one kind.
struct TypicalFailure {
  int row = 0;   ///< index into SweepResult::rows
  int kind = 0;  ///< index into Explanation::clusters
  ComparedPair paths;
};

/// What the page shows and the result does not hold.
struct PageEvidence {
  std::vector<TypicalFailure> failures;
  /// Of `rift gap`, behind the two logs of a row, so that it comes out as in the table; where the
  /// candidates are simulated, `rift simulate --replay` drives a row again.
  std::string gap_flags;
  std::vector<sweep::ProgramCell> programs;  ///< of a grid over a program
};

/// The same with an explanation at hand.
std::string RenderPage(const sweep::SweepResult& result, const sweep::Explanation& explanation,
                       const PageEvidence& evidence, const ReportOptions& options = {});

}  // namespace rift::report
