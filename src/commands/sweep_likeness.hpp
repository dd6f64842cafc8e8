#pragma once

#include <vector>

#include "rift/experiment/experiment.hpp"
#include "rift/sweep/calibrate/sweep_likeness.hpp"
#include "sweep_sources.hpp"

namespace rift::commands {

/// Likeness of a grid sweep's candidates to its repeated reference logs, by the values of its main
/// factor and over all ("all", last). Empty where the sweep has no repeated logs to be like.
std::vector<sweep::GroupLikeness> MeasureSweepLikeness(const experiment::Experiment& experiment,
                                                       SweepSources& sources);

}  // namespace rift::commands
