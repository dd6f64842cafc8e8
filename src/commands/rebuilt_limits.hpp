#pragma once

#include "rift/config/experiment.hpp"
#include "rift/sweep/grid_sweep.hpp"

namespace rift::commands {

/// A recorded run with what its controller must have asked for: the experiment's controller, with
/// those parameters of the setting that name its keys ("v_max"), over the logged poses.
sweep::Recording WithLimits(sweep::Recording log, const config::Experiment& experiment,
                            const sweep::Theta& theta, double tag_offset_m);

}  // namespace rift::commands
