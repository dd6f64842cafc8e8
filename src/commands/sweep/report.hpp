#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "rift/sweep/explain/explanation.hpp"
#include "rift/sweep/explain/program_cells.hpp"
#include "rift/sweep/falsify/evaluator.hpp"

namespace rift::commands {

/// Draws the figures (SVG and PNG, in DIR/figures) and writes DIR/report.html. `evaluator` brings
/// the paths of the worst trial and of a typical failure of each kind again. Figures that make no
/// sense for this space are named on stderr.
void WriteSweepReport(const std::filesystem::path& folder, const sweep::SweepResult& result,
                      const sweep::Explanation& explanation,
                      const std::vector<sweep::ProgramCell>& programs, sweep::Evaluator& evaluator);

/// The page of a sweep that still runs, of the trials so far, without figures.
std::string RunningReport(const sweep::SweepResult& result, sweep::Evaluator& evaluator);

}  // namespace rift::commands
