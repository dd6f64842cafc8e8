#pragma once

#include <string>
#include <vector>

#include "rift/geometry/floor.hpp"
#include "rift/report/figures/figure.hpp"
#include "rift/trajectory/trajectory.hpp"

namespace rift::report {

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

}  // namespace rift::report
