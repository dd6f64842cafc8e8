#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "rift/gap/options.hpp"
#include "rift/trajectory/trajectory.hpp"

namespace rift::sweep {

/// What several features of a log are made of. The log must outlive it.
struct DriveMeasures {
  DriveMeasures(const trajectory::Trajectory& drive, const gap::LikenessOptions& options);

  /// Distance of neighbouring rows over their time, from the first motion on.
  double RowSpeed_mps(size_t row) const { return steps_m[row] / intervals_s[row]; }
  bool IsMoving() const { return first + 4 < log.poses.size(); }

  const trajectory::Trajectory& log;
  std::vector<double> intervals_s;  ///< from each row to the next
  std::vector<double> steps_m;      ///< likewise
  Eigen::Vector2d rest_m;           ///< where it stood: median of the first rows
  size_t first = 0;                 ///< row of the first motion; the number of rows: none
  double cruise_mps;                ///< median speed while moving
  std::vector<double> speeds_mps;   ///< over the stride of the options, from the first motion on
  std::vector<double> yaw_rad;      ///< unwrapped; empty without yaw
  std::vector<double> yaw_rates_rad_s;  ///< evenly in time (kGrid_s), from the first motion on
  std::vector<double> lateral_m;  ///< left of the line from start to end, from the first motion on
  std::vector<size_t> passed;     ///< rows at which the next waypoint became the target

  static constexpr double kGrid_s = 0.05;
};

/// Numbers that a sequence of values is told by; NaN when it is too short or does not vary.

double ShareOf(const std::vector<double>& values, const std::function<bool(double)>& is_meant);

/// The standard deviation of normal values about zero with this median size: two rows stamped
/// nearly at once decide nothing.
double RobustScatter(std::vector<double> values);

/// With itself `lag` values later; at least eight pairs.
double Autocorrelation(const std::vector<double>& values, size_t lag);

/// Sarle's coefficient: 1/3 of normal values, 5/9 of evenly spread ones, 1 of two points.
double Bimodality(const std::vector<double>& values);

}  // namespace rift::sweep
