#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "rift/sweep/calibrate/calibration.hpp"

namespace rift::sweep {

/// What one drive of a log's task is like: the features of drive_features without those of time
/// stamps, then loop delay, steering gain and bias, then how far left of the straight line to it
/// each waypoint was passed. NaN where it does not tell.
Eigen::VectorXd FeatureRow(const trajectory::Trajectory& path, const SimulatedTrial& twin);

/// The logs, each driven once at one set of values.
struct FeatureRows {
  Eigen::MatrixXd rows;        ///< logs x features; NaN for drives that failed
  Eigen::VectorXd has_failed;  ///< 1 for a drive that did not arrive, or only on a detour
};

/// One element for each set of values. The first `alike` sets, and each `alike` after them, are
/// driven with the same noise, which is that of no other sets, logs or `round`. `threads` drive at
/// once and change no result.
std::vector<FeatureRows> DriveAt(const std::vector<std::vector<double>>& values,
                                 const std::vector<CalibrationLog>& logs, const TwinAt& twin,
                                 std::uint64_t round, int alike, int threads);

}  // namespace rift::sweep
