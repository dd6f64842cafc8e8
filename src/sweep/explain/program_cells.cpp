#include "rift/sweep/explain/program_cells.hpp"

#include <fmt/format.h>

#include "rift/sweep/falsify/settings.hpp"

namespace rift::sweep {

std::vector<ProgramCell> MeasurePrograms(Evaluator& evaluator) {
  const experiment::Experiment& experiment = evaluator.experiment();
  if (experiment.program.segments.empty() || experiment.goal != experiment::Goal::kGrid) return {};
  const bool is_simulated = experiment.candidate.kind == experiment::CandidateKind::kSimulation;
  odometry::RunOptions options;
  if (is_simulated) options.tag_ahead_m = experiment.simulation.mocap.tag_ahead_m;
  std::vector<ProgramCell> cells;
  for (const experiment::Theta& theta : experiment::GridPoints(experiment.space.parameters)) {
    ProgramCell cell{.theta = theta};
    const trajectory::Trajectory program = evaluator.IdealPathAt(theta);
    std::vector<trajectory::Trajectory> paths;
    for (const TrialRequest& request : TrialsAt(experiment, theta)) {
      CandidateRun run = evaluator.RunOf(request, {});
      const Recording& camera = run.camera;
      // A robot that was too weak for the program ran out of time or road, and its log shows it.
      if (camera.trajectory.poses.size() < 2) {
        cell.lost.push_back(fmt::format("trial {}: {}", request.trial, camera.reason));
        continue;
      }
      const odometry::RunLog log{camera.source, camera.trajectory, std::move(run.encoders)};
      cell.runs.push_back(
          odometry::MeasureRun(log, program, experiment.hardware.odometry, options));
      paths.push_back(camera.trajectory);
    }
    cell.measures = odometry::MeasureCell(cell.runs, paths);
    cells.push_back(std::move(cell));
  }
  return cells;
}

}  // namespace rift::sweep
