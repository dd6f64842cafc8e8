#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "rift/sessions/sweep/observer.hpp"
#include "rift/sweep/calibrate/likeness.hpp"
#include "rift/sweep/explain/explanation.hpp"
#include "rift/sweep/explain/program_cells.hpp"
#include "rift/sweep/falsify/evaluator.hpp"

namespace rift::sessions {

/// What the trials of a sweep tell beside its table; no further trial is run for it.
struct SweepFindings {
  sweep::Explanation explanation;
  std::vector<sweep::GroupLikeness> likeness;  ///< of sweeps whose reference is logs
  std::vector<sweep::ProgramCell> programs;    ///< of a grid over a program
  std::vector<std::string> notes;              ///< what of this could not be had, and why
};

/// Explains a sweep, the drives of the robot that are saved in its folder included. Where up to
/// `suggest` > 0 experiments on the robot are asked for, they are written to suggested.yaml.
/// `jobs` changes no result.
SweepFindings ExplainSweep(const std::filesystem::path& folder, sweep::Evaluator& evaluator,
                           const sweep::SweepResult& result, int suggest, int jobs);

/// Writes DIR/explanation.json, programs.json and likeness.json, the figures (SVG and PNG, in
/// DIR/figures) and DIR/report.html. `evaluator` brings the paths of the worst trial again. Figures
/// that make no sense for this space are named to the observer, and so is what could not be had.
void SaveReport(const std::filesystem::path& folder, sweep::Evaluator& evaluator,
                const sweep::SweepResult& result, const SweepFindings& findings,
                const SweepObserver& observer);

}  // namespace rift::sessions
