#include "simulated_recording.hpp"

#include <fmt/format.h>

#include <algorithm>

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

/// `next` is the first waypoint that was not reached.
double AlongPath_m(const Eigen::Vector2d& end_m, const std::vector<control::Waypoint>& waypoints,
                   size_t next) {
  double left_m = next < waypoints.size() ? (waypoints[next].Position() - end_m).norm() : 0.0;
  for (; next + 1 < waypoints.size(); ++next) {
    left_m += (waypoints[next + 1].Position() - waypoints[next].Position()).norm();
  }
  return left_m;
}

/// The point of a straight line between two that is nearest to a third.
Eigen::Vector2d NearestOn(const Eigen::Vector2d& from_m, const Eigen::Vector2d& to_m,
                          const Eigen::Vector2d& point_m) {
  const Eigen::Vector2d way_m = to_m - from_m;
  const double square_m2 = way_m.squaredNorm();
  if (square_m2 == 0.0) return from_m;
  return from_m + std::clamp((point_m - from_m).dot(way_m) / square_m2, 0.0, 1.0) * way_m;
}

double DistanceLeft_m(const SimulatedRun& run, const std::vector<control::Waypoint>& waypoints) {
  size_t next = 1;
  while (next < waypoints.size() && run.result.visits[next - 1].reached_s) ++next;
  const Eigen::Vector2d end = run.truth.poses.empty() ? waypoints.front().Position()
                                                      : Eigen::Vector2d(run.truth.poses.back().x_m,
                                                                        run.truth.poses.back().y_m);
  return AlongPath_m(end, waypoints, next);
}

}  // namespace

double WayLeft_m(const trajectory::Trajectory& log, const std::vector<control::Waypoint>& waypoints,
                 double reach_radius_m) {
  size_t next = 1;
  Eigen::Vector2d from_m = log.poses.front().Position();
  for (const trajectory::StampedPose& pose : log.poses) {
    for (; next < waypoints.size(); ++next) {
      const Eigen::Vector2d at_m = waypoints[next].Position();
      const Eigen::Vector2d nearest_m = NearestOn(from_m, pose.Position(), at_m);
      if ((nearest_m - at_m).norm() > reach_radius_m) break;
      from_m = nearest_m;
    }
    from_m = pose.Position();
  }
  return AlongPath_m(log.poses.back().Position(), waypoints, next);
}

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
