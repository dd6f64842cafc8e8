#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "rift/sessions/sweep/observer.hpp"
#include "rift/sweep/calibrate/identification.hpp"
#include "rift/sweep/falsify/evaluator.hpp"
#include "rift/sweep/run/slurm_options.hpp"

namespace rift::sessions {

/// Where a simulator is fitted to logs, none of which the fit depends on.
struct FitRequest {
  std::filesystem::path out;
  int jobs = 1;
  bool fresh = false;                            ///< of a cluster: forget an earlier fit
  const sweep::SlurmOptions* cluster = nullptr;  ///< a job there makes it, if not this process
};

/// Fits and judges, telling `say` what goes on. Nothing when it was told to stop, which can be
/// asked of a fit on a cluster alone: the same call goes on.
std::optional<sweep::CalibrationReport> Fit(sweep::Evaluator& evaluator, const FitRequest& request,
                                            const SweepObserver& observer, const sweep::Say& say);

/// Whether a line that was told is a note or a warning about what was fitted, and no progress.
bool IsNote(const std::string& line);

/// Writes experiment.yaml, inputs.txt and calibration.json.
void SaveCalibration(const std::filesystem::path& folder, const sweep::Evaluator& evaluator,
                     const sweep::CalibrationReport& found);

/// Writes the figure into DIR/figures. False when there is nothing to draw: no log has a simulated
/// run that reached the end, both before and after the fit.
bool SaveCalibrationFigure(const std::filesystem::path& folder, const std::string& name,
                           const sweep::CalibrationReport& found);

}  // namespace rift::sessions
