#pragma once

#include "request.hpp"
#include "rift/experiment/experiment.hpp"
#include "rift/sweep/run/slurm_options.hpp"

namespace rift::commands {

/// Fits, judges, writes calibration.json, experiment.yaml, inputs.txt, figures and the robot's
/// file, and prints the table; returns the exit code. With a cluster the fit is made there.
int Calibrate(const SweepRequest& request, const experiment::Experiment& experiment,
              const sweep::SlurmOptions* cluster);

}  // namespace rift::commands
