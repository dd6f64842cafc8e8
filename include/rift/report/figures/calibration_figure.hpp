#pragma once

#include <optional>
#include <string>
#include <vector>

#include "rift/report/figures/figure.hpp"
#include "rift/sweep/calibrate/identification.hpp"
#include "rift/trajectory/trajectory.hpp"

namespace rift::report {

/// A real trial and how far the mean simulated path was from it, in m; NaN is not drawn.
struct CalibratedTrial {
  std::string level;
  bool is_held_out = false;
  double gap_before_m = 0.0;
  double gap_after_m = 0.0;
};

/// After the fit over before it, a point for each trial, fitted and held out told apart: below the
/// diagonal the fit helped. Throws std::invalid_argument for no trial with both gaps.
Figure CalibrationGapFigure(const std::vector<CalibratedTrial>& trials,
                            const ReportOptions& options = {});

/// The paths of one trial: the robot's, and some simulated ones before and after the fit.
struct CalibratedPaths {
  std::string name;
  trajectory::Trajectory real;
  std::vector<trajectory::Trajectory> before, after;
};

Figure CalibrationPathFigure(const CalibratedPaths& paths, const ReportOptions& options = {});

/// Gap of each trial before and after the fit, and the paths of one trial, below each other.
/// Nothing when no trial has both gaps.
std::optional<Figure> CalibrationFigure(const std::string& name,
                                        const sweep::CalibrationReport& report);

}  // namespace rift::report
