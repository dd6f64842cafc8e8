#include "simulated_recording.hpp"

#include <fmt/format.h>

#include "rift/trajectory/frame_grid.hpp"

namespace rift::sweep {

TrialStatus StatusOf(trial::Outcome outcome) {
  switch (outcome) {
    case trial::Outcome::kReached:
      return TrialStatus::kOk;
    case trial::Outcome::kTimedOut:
      return TrialStatus::kTimedOut;
    case trial::Outcome::kFell:
      return TrialStatus::kFell;
    case trial::Outcome::kLeftArena:
      return TrialStatus::kLeftArena;
    case trial::Outcome::kLost:
      return TrialStatus::kLost;
    case trial::Outcome::kFault:
      return TrialStatus::kFault;
  }
  return TrialStatus::kFault;
}

namespace {

/// Along the path from where the robot ended to the last waypoint.
double DistanceLeft_m(const SimulatedRun& run, const std::vector<control::Waypoint>& waypoints) {
  size_t next = 1;
  while (next < waypoints.size() && run.result.visits[next - 1].reached_s) ++next;
  const Eigen::Vector2d end = run.truth.poses.empty() ? waypoints.front().Position()
                                                      : Eigen::Vector2d(run.truth.poses.back().x_m,
                                                                        run.truth.poses.back().y_m);
  double left_m = next < waypoints.size() ? (waypoints[next].Position() - end).norm() : 0.0;
  for (; next + 1 < waypoints.size(); ++next) {
    left_m += (waypoints[next + 1].Position() - waypoints[next].Position()).norm();
  }
  return left_m;
}

}  // namespace

Recording RecordingOf(SimulatedRun run, const SimulatedTrial& trial, double grid_fps) {
  Recording recording{.status = StatusOf(run.result.outcome),
                      .source = fmt::format("simulation with seed {}", trial.seed),
                      .limits = run.result.limits};
  if (recording.status != TrialStatus::kOk) {
    recording.reason = run.result.reason;
    recording.left_m = DistanceLeft_m(run, trial.task.waypoints);
  }
  recording.trajectory = trajectory::OnFramesOf(std::move(run.result.trajectory), grid_fps);
  return recording;
}

}  // namespace rift::sweep
