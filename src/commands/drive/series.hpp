#pragma once

#include "request.hpp"
#include "rift/experiment/experiment.hpp"

namespace rift::commands {

/// `rift drive --grid` and `--repeat`: drives what is not done yet, asks about what was begun and
/// not finished, writes sweep.yaml and, of a grid, runs it. Returns the exit code.
int DriveSeries(const DriveRequest& request, const experiment::Experiment& experiment);

}  // namespace rift::commands
