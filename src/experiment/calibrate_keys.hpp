#pragma once

#include <string>

#include "rift/experiment/experiment.hpp"

namespace rift::experiment {

/// Makes full keys of those in calibrate.fit, one for each level where a key has {surface} in it,
/// and starts each where the experiment has it. Throws Error for a calibration that cannot be.
void ResolveCalibrate(Experiment& experiment, const std::string& path);

}  // namespace rift::experiment
