#pragma once

#include <optional>
#include <string>
#include <vector>

#include "rift/gap/comparison.hpp"
#include "rift/gap/options.hpp"
#include "rift/gap/result.hpp"
#include "rift/geometry/floor.hpp"
#include "rift/report/figures/figure.hpp"
#include "rift/sweep/calibrate/identification.hpp"
#include "rift/sweep/falsify/result.hpp"
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

/// One simulated path against one real one, as the figures of `rift gap` need it.
struct ComparedPair {
  std::string sim;  ///< how the legend names it
  std::string real;
  gap::Comparison comparison;
  gap::ErrorProfile profile;  ///< of the whole path, the share left out at the start included
  std::vector<Eigen::Vector2d> waypoints_m;  ///< see LoggedWaypoints; may be empty
  bool is_in_space = false;                  ///< the comparison counts heights
};

/// Compares and keeps what is drawn. Throws as gap::Compare.
ComparedPair ComparePair(std::string sim_name, const trajectory::Trajectory& sim,
                         std::string real_name, const trajectory::Trajectory& real,
                         const gap::GapOptions& gap);

/// The targets a log names, each once, in the order they were driven to.
std::vector<Eigen::Vector2d> LoggedWaypoints(const trajectory::Trajectory& trajectory);

/// The paths in the plane (those in space as seen from above) at equal scale, with start, end,
/// waypoints and the line that joins the two points of the largest error. All functions below throw
/// std::invalid_argument for no pair.
Figure OverlayFigure(const std::vector<ComparedPair>& pairs, const ReportOptions& options = {});

/// Figure 9 of the paper: error over u, with the maximum and the threshold.
Figure ErrorFigure(const std::vector<ComparedPair>& pairs, const gap::GapOptions& gap,
                   const ReportOptions& options = {});

/// Share of the path whose error stays below a value.
Figure ErrorCdfFigure(const std::vector<ComparedPair>& pairs, const gap::GapOptions& gap,
                      const ReportOptions& options = {});

/// The three above, in this order.
std::vector<Figure> GapFigures(const std::vector<ComparedPair>& pairs, const gap::GapOptions& gap,
                               const ReportOptions& options = {});

/// The three of them below each other, a pair for each trial.
Figure GapFigure(const gap::GapResult& result);

/// One simulated trial as values.
struct SimulatedTrial {
  std::string name;              ///< how the caption calls it
  trajectory::Trajectory truth;  ///< where it really was: at least two poses; z may be unknown
  /// What the tracker saw, on the same clock; may be empty. Channels power_left and power_right,
  /// here or in truth (that comes first), are drawn over time.
  trajectory::Trajectory logged;
  std::vector<geometry::NamedPoint> waypoints;  ///< the start is one of them
  std::vector<geometry::FloorArea> areas;
  std::vector<Eigen::Vector2d> ground_xz_m;  ///< profile of the ground by rising x; may be empty
};

/// Top view, side view, and speed and wheel powers over time, below each other. What is not known
/// (heights, powers) is left out.
/// Throws std::invalid_argument when truth has fewer than two poses.
Figure SimulationFigure(const SimulatedTrial& trial, const ReportOptions& options = {});

struct SweepFigureSet {
  std::vector<Figure> figures;
  std::vector<OmittedFigure> omitted;  ///< with the reason why
};

/// Figures 7, 8, 10, 11, 12 and 13 of the paper for any parameter space, and a scatter plot for
/// each continuous axis. Figure 9 is drawn from the paths of one trial: pass the worst one.
SweepFigureSet SweepFigures(const sweep::SweepResult& result,
                            const std::optional<ComparedPair>& worst = {},
                            const ReportOptions& options = {});

}  // namespace rift::report
