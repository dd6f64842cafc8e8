#pragma once

#include <string>
#include <vector>

#include "rift/gap/options.hpp"
#include "rift/trajectory/trajectory.hpp"

namespace rift::gap {

/// What makes a comparison of two logs doubtful though each log looks sound, one line each, in
/// which the logs are called SIM and REAL: one is in another unit of length, mirrored, or has its
/// axes swapped; one was driven the other way; one covers only a part of the other's path and
/// begins or ends in motion; their clocks differ (of what options.trim_standstill leaves); they are
/// the same log. In space z counts as well.
std::vector<std::string> Doubts(const trajectory::Trajectory& sim,
                                const trajectory::Trajectory& real, const GapOptions& options = {});

/// Whether a path of at least two poses never leaves options.standstill_radius_m of its first one,
/// so that all of it is standstill and options.trim_standstill leaves nothing to compare.
bool IsStanding(const trajectory::Trajectory& path, const GapOptions& options);

/// REAL has even time steps and no noise, SIM uneven ones and noise.
bool LookSwapped(const trajectory::Trajectory& sim, const trajectory::Trajectory& real);

}  // namespace rift::gap
