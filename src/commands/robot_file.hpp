#pragma once

#include <string>

#include "rift/sweep/calibrate/identification.hpp"

namespace rift::commands {

/// The fitted robot as YAML to be used as `include:`: every key of trial and simulation that is not
/// at its default, the fitted ones with their intervals, and on top how and from which logs.
/// `inputs` are the logs' fingerprints, one a line.
std::string RobotYaml(const experiment::Experiment& experiment,
                      const sweep::CalibrationReport& report, const std::string& inputs,
                      const std::string& experiment_file);

}  // namespace rift::commands
