#pragma once

#include <filesystem>

#include "request.hpp"
#include "rift/experiment/experiment.hpp"

namespace rift::commands {

/// `rift drive --grid`, `--repeat`, `--identify` and `--suggested` into `out`; of a grid, `rift
/// sweep` of the drives as well. Returns the exit code.
int DriveSeries(const DriveRequest& request, const experiment::Experiment& experiment,
                const std::filesystem::path& out);

}  // namespace rift::commands
