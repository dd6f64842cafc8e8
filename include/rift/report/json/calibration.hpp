#pragma once

#include <string>

#include "rift/experiment/experiment.hpp"
#include "rift/sweep/calibrate/identification.hpp"

namespace rift::report {

/// calibration.json: {name, confidence, fit, judged, errors, trials, missing}; the same report
/// gives the same bytes.
std::string CalibrationJson(const experiment::Experiment& experiment,
                            const sweep::CalibrationReport& report);

}  // namespace rift::report
