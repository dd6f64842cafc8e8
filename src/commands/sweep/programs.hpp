#pragma once

#include <string>

#include "rift/experiment/experiment.hpp"

namespace rift::commands {

/// Throws std::invalid_argument when the program of candidate.run or reference.run is not there or
/// not executable; `file` is the experiment's.
void RequirePrograms(const experiment::Experiment& experiment, const std::string& file);

}  // namespace rift::commands
