#include "rift/sweep/explain/program_cells.hpp"

#include <fmt/format.h>

#include <optional>
#include <stdexcept>

#include "rift/sweep/falsify/candidate_runs.hpp"
#include "rift/sweep/falsify/settings.hpp"
#include "rift/yaml/node.hpp"

namespace rift::sweep {
namespace {

/// Runs again, one after another.
class RunsOfCells {
 public:
  explicit RunsOfCells(Evaluator& evaluator) : evaluator_(evaluator) {
    // In a process that is given up when its program hangs, as the trials of the sweep were.
    if (evaluator.experiment().candidate.kind == experiment::CandidateKind::kProgram) {
      programs_.emplace(evaluator, 1);
    }
  }

  ProgramCell At(const experiment::Theta& theta);

 private:
  CandidateRun RunOf(const TrialRequest& request) {
    if (programs_) return {programs_->Run({request}).front(), {}};
    return evaluator_.RunOf(request, {});
  }
  /// Throws what the task of the setting, the run and its files throw.
  void Add(const TrialRequest& request, ProgramCell& cell);

  Evaluator& evaluator_;
  std::optional<CandidateRuns> programs_;
  std::vector<trajectory::Trajectory> paths_;  ///< of the cell
};

void RunsOfCells::Add(const TrialRequest& request, ProgramCell& cell) {
  const trajectory::Trajectory program = evaluator_.IdealPathAt(request.theta);
  CandidateRun run = RunOf(request);
  const Recording& camera = run.camera;
  // A robot that was too weak for the program ran out of time or road, and its log shows it.
  if (camera.trajectory.poses.size() < 2) throw std::invalid_argument(camera.reason);
  const odometry::RunLog log{camera.source, camera.trajectory, std::move(run.encoders)};
  const experiment::Experiment& experiment = evaluator_.experiment();
  const odometry::RunOptions options{.tag_ahead_m = TagAhead_m(experiment, request)};
  cell.runs.push_back(odometry::MeasureRun(log, program, experiment.hardware.odometry, options));
  paths_.push_back(camera.trajectory);
}

ProgramCell RunsOfCells::At(const experiment::Theta& theta) {
  ProgramCell cell{.theta = theta};
  paths_.clear();
  for (const TrialRequest& request : TrialsAt(evaluator_.experiment(), theta)) {
    const auto lose = [&](const std::exception& why) {
      cell.lost.push_back(fmt::format("trial {}: {}", request.trial, why.what()));
    };
    try {
      Add(request, cell);
    } catch (const std::invalid_argument& no_run) {
      lose(no_run);
    } catch (const yaml::Error& broken_rule) {
      lose(broken_rule);
    }
  }
  cell.measures = odometry::MeasureCell(cell.runs, paths_);
  return cell;
}

}  // namespace

std::vector<ProgramCell> MeasurePrograms(Evaluator& evaluator) {
  const experiment::Experiment& experiment = evaluator.experiment();
  if (experiment.program.segments.empty() || experiment.goal != experiment::Goal::kGrid) return {};
  RunsOfCells runs(evaluator);
  std::vector<ProgramCell> cells;
  for (const experiment::Theta& theta : experiment::GridPoints(experiment.space.parameters)) {
    cells.push_back(runs.At(theta));
  }
  return cells;
}

}  // namespace rift::sweep
