#pragma once

#include <random>

#include "model.hpp"

namespace rift::sweep {

/// Adds the parameters of `result` (value, interval, flags) and their correlation.
/// `estimate`: shares at the end; `at`: the logs linearised where the last step set out from;
/// `simulated`: simulated logs linearised where each correction set out from, the last one there;
/// none for a fit that was not corrected.
void Judge(const std::vector<experiment::FreeParameter>& parameters,
           const CalibrationOptions& options, const Eigen::VectorXd& estimate, const Linearised& at,
           const std::vector<Linearised>& simulated, const Prior& prior, std::mt19937_64& generator,
           Calibration& result);

}  // namespace rift::sweep
