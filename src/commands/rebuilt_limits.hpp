#pragma once

#include "rift/experiment/experiment.hpp"
#include "rift/sweep/falsify/grid.hpp"

namespace rift::commands {

/// A recorded run with what its controller must have asked for: the experiment's controller, with
/// those parameters of the setting that name its keys ("v_max"), over the logged poses.
sweep::Recording WithLimits(sweep::Recording log, const experiment::Experiment& experiment,
                            const experiment::Theta& theta, double tag_offset_m);

}  // namespace rift::commands
