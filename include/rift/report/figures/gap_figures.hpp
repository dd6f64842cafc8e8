#pragma once

#include <string>
#include <vector>

#include "rift/gap/comparison.hpp"
#include "rift/gap/options.hpp"
#include "rift/gap/result.hpp"
#include "rift/report/figures/figure.hpp"
#include "rift/trajectory/trajectory.hpp"

namespace rift::report {

/// One simulated path against one real one, as the figures of `rift gap` need it.
struct ComparedPair {
  std::string sim;  ///< how the legend names it
  std::string real;
  gap::Comparison comparison;
  gap::ErrorProfile profile;  ///< of the whole path, the share left out at the start included
  std::vector<Eigen::Vector2d> waypoints_m;  ///< see LoggedWaypoints; may be empty
};

/// Compares and keeps what is drawn. Throws as gap::Compare.
ComparedPair ComparePair(std::string sim_name, const trajectory::Trajectory& sim,
                         std::string real_name, const trajectory::Trajectory& real,
                         const gap::GapOptions& gap);

/// The targets a log names, each once, in the order they were driven to.
std::vector<Eigen::Vector2d> LoggedWaypoints(const trajectory::Trajectory& trajectory);

/// The paths in the plane at equal scale, with start, end, waypoints and the line that joins the
/// two points of the largest error. All functions below throw std::invalid_argument for no pair.
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

}  // namespace rift::report
