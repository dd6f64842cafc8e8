// The strongest evidence that the controller is the authors': their Webots runs, rebuilt from a
// unicycle with their wheel speed, 32 ms steps and no delay, meet their logged paths.

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <string>

#include "rift/control/navigator.hpp"
#include "rift/geometry/pose2.hpp"
#include "support/inputs/paper_waypoints.hpp"
#include "support/inputs/trials.hpp"

namespace rift::control {
namespace {

constexpr double kStep_s = 0.032;
// Facts: their delay buffer hands out nothing for two steps, then always the newest command.
constexpr int kStepsWithoutCommand = 2;

NavigatorOptions AuthorsOptions(const test::TrialLog& trial) {
  NavigatorOptions options;
  options.v_min = trial.v_min;
  options.v_max = trial.v_max;
  return options;
}

std::vector<Eigen::Vector2d> Rebuild(const test::TrialLog& trial, const NavigatorOptions& options) {
  const DiffDrive drive;
  Navigator navigator(options, test::PaperWaypoints());
  geometry::Pose2 pose = trial.log.poses.front().Planar();
  std::vector<Eigen::Vector2d> path{pose.Position()};
  for (int step = 0; step < 400; ++step) {
    const double now_s = step * kStep_s;
    const Decision decision = navigator.Step({now_s, kStep_s, now_s, pose});
    if (decision.finished) break;
    if (step >= kStepsWithoutCommand) pose = drive.Drive(pose, decision.power, kStep_s);
    path.push_back(pose.Position());
  }
  REQUIRE(navigator.finished());
  return path;
}

double DistanceToSegment_m(const Eigen::Vector2d& p, const Eigen::Vector2d& a,
                           const Eigen::Vector2d& b) {
  const Eigen::Vector2d along = b - a;
  const double length2 = along.squaredNorm();
  const double share = length2 > 0.0 ? std::clamp((p - a).dot(along) / length2, 0.0, 1.0) : 0.0;
  return (p - a - share * along).norm();
}

double LargestDistance_m(const trajectory::Trajectory& log,
                         const std::vector<Eigen::Vector2d>& path) {
  double largest_m = 0.0;
  for (const trajectory::StampedPose& pose : log.poses) {
    double nearest_m = std::numeric_limits<double>::infinity();
    for (size_t i = 1; i < path.size(); ++i) {
      nearest_m = std::min(nearest_m, DistanceToSegment_m(pose.Position(), path[i - 1], path[i]));
    }
    largest_m = std::max(largest_m, nearest_m);
  }
  return largest_m;
}

void CheckSurface(const std::string& surface, double bound_m) {
  for (const test::TrialLog& trial : test::LogsOn(surface, trajectory::Format::kWebots)) {
    const std::vector<Eigen::Vector2d> path = Rebuild(trial, AuthorsOptions(trial));
    const double distance_m = LargestDistance_m(trial.log, path);
    INFO(trial.name << ": " << 1e3 * distance_m << " mm, rows " << trial.log.poses.size() << " and "
                    << path.size());
    CHECK(distance_m < bound_m);
    CHECK(std::abs(static_cast<double>(trial.log.poses.size()) - static_cast<double>(path.size())) <
          6);
  }
}

TEST_CASE("The authors' Webots paths on ground are met within 3 mm") {
  RIFT_SKIP_WITHOUT_TRIALS();
  CheckSurface("ground", 0.003);
}

TEST_CASE("The authors' Webots paths on cardboard are met within 4 mm") {
  RIFT_SKIP_WITHOUT_TRIALS();
  CheckSurface("cardboard", 0.004);
}

TEST_CASE("The authors' Webots paths on slippery parchment are met within 15 mm") {
  RIFT_SKIP_WITHOUT_TRIALS();
  CheckSurface("parchment", 0.015);
}

// What the logs themselves say about the first step of a leg: the row after the last one that
// names the old target.
TEST_CASE("The logged first steering of a leg shows the derivative kick") {
  RIFT_SKIP_WITHOUT_TRIALS();
  double with_kick = 0.0, without = 0.0;
  int legs = 0;
  for (const test::TrialLog& trial : test::LogsOn("ground", trajectory::Format::kWebots)) {
    const std::vector<trajectory::StampedPose>& rows = trial.log.poses;
    for (size_t i = 1; i + 1 < rows.size(); ++i) {
      const trajectory::StampedPose& row = rows[i];
      if (row.target_x_m == rows[i - 1].target_x_m || row.target_x_m > 0.3) continue;
      const double turn_rad = geometry::WrapToPi(rows[i + 1].yaw_rad - row.yaw_rad);
      const DiffDriveOptions drive;
      const double power_of_turn = turn_rad / kStep_s * 0.5 * drive.track_m /
                                   (drive.wheel_radius_m * drive.full_power_speed_rad_s);
      for (const bool kick : {true, false}) {
        NavigatorOptions options = AuthorsOptions(trial);
        options.derivative_kick = kick;
        Navigator navigator(
            options, {{"", 0.0, 0.0, {}, true}, {"", row.target_x_m, row.target_y_m, {}, true}});
        const Decision decision = navigator.Step({0.0, kStep_s, 0.0, row.Planar()});
        (kick ? with_kick : without) += std::abs(decision.w - power_of_turn);
      }
      ++legs;
    }
  }
  REQUIRE(legs > 0);
  CHECK(with_kick / legs < 0.010);
  CHECK(without / legs > 0.015);
}

}  // namespace
}  // namespace rift::control
