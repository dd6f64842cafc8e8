#pragma once

#include <filesystem>

#include "rift/config/experiment.hpp"
#include "rift/sweep/log_sweep.hpp"

namespace rift::commands {

/// Draws the figures (SVG and PNG, in DIR/figures) and writes DIR/report.html. `source` brings the
/// paths of the worst trial again. Figures that make no sense for this space are named on stderr.
void WriteSweepReport(const std::filesystem::path& folder, const sweep::SweepResult& result,
                      const sweep::LogSource& source);

}  // namespace rift::commands
