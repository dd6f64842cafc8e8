#pragma once

#include <cstddef>
#include <vector>

#include "rift/gap/comparison.hpp"
#include "rift/sweep/calibrate/calibration.hpp"

namespace rift::sweep {

/// What is left of the errors of short-horizon predictions (simulated minus logged), and its shape:
/// an error with a lag, a side or a frequency has a cause that a better model could name. NaN where
/// the logs cannot tell.
struct ErrorStructure {
  size_t motions = 0;                    ///< over the longest horizon
  double horizon_s = gap::kNotComputed;  ///< mean duration of these
  double ahead_m = gap::kNotComputed;    ///< root mean square
  double left_m = gap::kNotComputed;
  double turned_rad = gap::kNotComputed;
  double ahead_bias_m = gap::kNotComputed;  ///< mean; positive: the simulator drives further
  double left_bias_m = gap::kNotComputed;
  double turned_bias_rad = gap::kNotComputed;
  /// Side: mean error of the turn where the simulator turned left, and right.
  double turning_left_rad = gap::kNotComputed;
  double turning_right_rad = gap::kNotComputed;
  /// Lag: by how much the simulated yaw rate comes after the logged one, where both fit best.
  double lag_s = gap::kNotComputed;
  /// Frequency: of the strongest wave in the errors of the turn, and its share of their variance.
  double frequency_hz = gap::kNotComputed;
  double frequency_share = gap::kNotComputed;
};

/// Over all logs, each replayed on its twin with these values.
ErrorStructure StructureOfErrors(const std::vector<CalibrationLog>& logs, const TwinAt& twin,
                                 const std::vector<double>& values,
                                 const ShortHorizonOptions& options);

}  // namespace rift::sweep
