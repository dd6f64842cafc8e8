#pragma once

#include <string>

#include "rift/config/experiment.hpp"

namespace rift::config {

/// Makes full keys of those in calibrate.fit, one for each level where a key has {surface} in it,
/// and starts each where the experiment has it. Throws Error for a calibration that cannot be.
void ResolveCalibrate(Experiment& experiment, const std::string& path);

}  // namespace rift::config
