#pragma once

#include <cstdint>
#include <vector>

#include "rift/sweep/calibrate/calibration.hpp"

namespace rift::sweep {

/// Goes on from where a fit by motions ended: to the values at which whole drives have the features
/// of the logs (simulated moments, McFadden 1989). In each round the parameters are drawn about the
/// estimate, each log is driven once at each draw, and the estimate goes to the least of the
/// FeatureModel made of them, at most two scatters of the draws away; the next round draws as far
/// as the estimate is uncertain. Values, intervals, correlation and losses of `found` are replaced:
/// the intervals are of the normal posterior at the end (Laplace), priors included.
/// Draws and estimates beyond what is allowed are those at its end, as they are at a bound.
/// Logs are grouped by CalibrationLog::group.
void FitFeatures(const std::vector<CalibrationLog>& logs, const TwinAt& twin,
                 const CalibrationOptions& options, std::uint64_t seed, int threads,
                 const CalibrationStep& on_step, Calibration& found,
                 const IsAllowed& is_allowed = {});

}  // namespace rift::sweep
