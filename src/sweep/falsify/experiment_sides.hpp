#pragma once

#include <optional>
#include <string>

#include "rift/experiment/experiment.hpp"

namespace rift::sweep {

/// Whether candidate and reference of an experiment can be held against each other: they name the
/// logs they need, and go together with its objective, start and gap. Throws std::invalid_argument
/// with the keys at fault.
void CheckSides(const experiment::Experiment& experiment);

/// The part of it for logs on both sides. Throws std::invalid_argument when a path template of logs
/// names no parameter, or a parameter or the trials are named by no path: the same rows would stand
/// there under several labels.
void CheckPaths(const experiment::Experiment& experiment);

/// Why a drive of the robot, whose experiment `text` is from `file`, is no trial of what is asked:
/// the first key of its task, controller or trial that is another. What its line, its camera and
/// the simulator were says nothing.
std::optional<std::string> WhyOtherDrive(const std::string& file, const std::string& text,
                                         const experiment::Experiment& asked);

}  // namespace rift::sweep
