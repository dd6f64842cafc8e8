#pragma once

#include "rift/vision/calibration/calibration.hpp"

namespace rift::vision {

/// Sets verdict and reasons from all else.
void Judge(Calibration& calibration, const CalibrationOptions& options);

}  // namespace rift::vision
