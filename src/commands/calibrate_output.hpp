#pragma once

#include <filesystem>
#include <string>

#include "rift/sweep/calibrate/identification.hpp"

namespace rift::commands {

/// Parameters with intervals and flags, correlations, both simulators by level and side, what is
/// left of the errors; for the terminal.
std::string CalibrationText(const sweep::CalibrationReport& report);

/// Everything as JSON; the same report gives the same bytes.
std::string CalibrationJson(const experiment::Experiment& experiment,
                            const sweep::CalibrationReport& report);

/// figures/calibration.svg and .png below `folder`: gap of each trial before and after the fit, and
/// the paths of one trial.
void WriteCalibrationFigures(const std::filesystem::path& folder,
                             const experiment::Experiment& experiment,
                             const sweep::CalibrationReport& report);

/// "at a bound", "not identifiable" or "no effect"; empty when there is nothing to warn of.
std::string FlagOf(const sweep::CalibratedParameter& parameter);

}  // namespace rift::commands
