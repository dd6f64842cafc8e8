#pragma once

#include <string>
#include <vector>

#include "rift/report/figures/figure.hpp"
#include "rift/report/figures/setting_grid.hpp"
#include "rift/sweep/falsify/result.hpp"

namespace rift::report {

/// Figure 7: a bar of the mean gap for each setting, grouped by the main factor; dots are trials.
Figure GapBySettingFigure(const sweep::SweepResult& result, const SettingGrid& grid,
                          const ReportOptions& options);

/// Figure 8: the gap of every trial, one line a setting.
Figure GapByTrialFigure(const sweep::SweepResult& result, const ReportOptions& options);

/// Figure 10: mean gap as a heat map, the number in each cell, and a cross where some of its trials
/// have no gap.
Figure HeatMapFigure(const sweep::SweepResult& result, const SettingGrid& grid,
                     const ReportOptions& options);

/// Figure 11: mean gap by level with its standard deviation.
Figure MeanByLevelFigure(std::string name, const std::string& factor,
                         const std::vector<sweep::LevelSummary>& levels, double threshold_m,
                         const ReportOptions& options);

/// Figures 12 and 13: trials that fail by level, of those that fail or do not.
Figure FailuresByLevelFigure(std::string name, const std::string& factor,
                             const std::vector<sweep::LevelSummary>& levels,
                             const ReportOptions& options);

/// The gap of every trial over a continuous parameter.
Figure GapOverParameterFigure(std::string name, const sweep::SweepResult& result, int parameter,
                              const ReportOptions& options);

}  // namespace rift::report
