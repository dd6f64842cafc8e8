#pragma once

#include <cstdint>

#include "rift/experiment/ensemble.hpp"
#include "rift/sweep/calibrate/calibration.hpp"

namespace rift::sweep {

/// Draws from what a fit leaves open, for `ensemble` of a robot's file: a normal distribution about
/// the fitted values (Laplace) whose intervals and correlations are those of the fit. Values beyond
/// a parameter's range are folded back into it, and draws of values (of all parameters) that are
/// not allowed are drawn again; where hundreds are not, the fitted values stand in. Parameters
/// without effect, and those that neither logs nor prior tell, are left out: they stay where they
/// are. The same seed gives the same draws.
experiment::Ensemble EnsembleOf(const Calibration& fit, double confidence, int draws,
                                std::uint64_t seed, const IsAllowed& is_allowed = {});

}  // namespace rift::sweep
