#pragma once

#include <optional>
#include <vector>

#include "rift/report/figures/figure.hpp"
#include "rift/report/figures/gap_figures.hpp"
#include "rift/sweep/falsify/result.hpp"

namespace rift::report {

struct SweepFigureSet {
  std::vector<Figure> figures;
  std::vector<OmittedFigure> omitted;  ///< with the reason why
};

/// Figures 7, 8, 10, 11, 12 and 13 of the paper for any parameter space, and a scatter plot for
/// each continuous axis. Figure 9 is drawn from the paths of one trial: pass the worst one.
SweepFigureSet SweepFigures(const sweep::SweepResult& result,
                            const std::optional<ComparedPair>& worst = {},
                            const ReportOptions& options = {});

/// Index of the row with the largest gap; empty when no trial has one.
std::optional<int> WorstRow(const sweep::SweepResult& result);

}  // namespace rift::report
