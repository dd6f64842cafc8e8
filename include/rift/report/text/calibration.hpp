#pragma once

#include <string>

#include "rift/experiment/experiment.hpp"
#include "rift/sweep/calibrate/identification.hpp"

namespace rift::report {

/// Parameters with intervals and flags, correlations, both simulators by level and side, what is
/// left of the errors.
std::string CalibrationText(const sweep::CalibrationReport& report);

/// The fitted robot as YAML to be used as `include:`: every key of trial and simulation that is not
/// at its default, the fitted ones with their intervals, and on top how and from which logs.
/// `inputs` are the logs' fingerprints, one a line.
std::string RobotYaml(const experiment::Experiment& experiment,
                      const sweep::CalibrationReport& report, const std::string& inputs,
                      const std::string& experiment_file);

/// "at a bound", "not identifiable" or "no effect"; empty when there is nothing to warn of.
std::string FlagOf(const sweep::CalibratedParameter& parameter);

}  // namespace rift::report
