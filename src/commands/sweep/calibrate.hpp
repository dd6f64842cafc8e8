#pragma once

#include "request.hpp"
#include "rift/experiment/experiment.hpp"

namespace rift::commands {

/// Fits, judges, writes calibration.json, experiment.yaml, inputs.txt, figures and the robot's
/// file, and prints the table; returns the exit code.
int Calibrate(const SweepRequest& request, const experiment::Experiment& experiment);

}  // namespace rift::commands
