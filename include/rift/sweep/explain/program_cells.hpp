#pragma once

#include <string>
#include <vector>

#include "rift/experiment/parameter.hpp"
#include "rift/odometry/program_runs.hpp"
#include "rift/sweep/falsify/evaluator.hpp"

namespace rift::sweep {

/// All repeats of a program at one setting (paper, figure 14).
struct ProgramCell {
  experiment::Theta theta;
  odometry::CellMeasures measures;
  std::vector<odometry::RunMeasures> runs;
  std::vector<std::string> lost;  ///< why a repeat has no run, one line each
};

/// The cells of a grid over a program, each run computed again (or its log read) with its encoders.
/// Empty when the experiment has no program or is no grid.
std::vector<ProgramCell> MeasurePrograms(Evaluator& evaluator);

}  // namespace rift::sweep
