// What a simulated trial is made of, and its true path.
#include "rift/sweep/falsify/simulated_trial.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <set>

#include "rift/geometry/pose2.hpp"
#include "rift/simulation/simulated_robot.hpp"
#include "support/inputs/memory_files.hpp"

namespace rift::sweep {
namespace {

TEST_CASE("The true path of a run begins as the robot stands, on a slope with roll and pitch") {
  SimulatedTrial trial{
      .task = std::vector<control::Waypoint>{{.name = "s"}, {.name = "e", .x_m = 0.3}},
      .start = {0.1, -0.2, 0.6},
      .seed = 3};
  trial.simulation.terrain.surface = "uphill";
  trial.trial.timeout_s = 1.0;
  const simulation::TruePose stood =
      simulation::SimulatedRobot(trial.simulation, trial.start, trial.seed).Truth();
  const SimulatedRun run = Simulate(trial);
  REQUIRE_FALSE(run.truth.poses.empty());
  const trajectory::StampedPose& first = run.truth.poses.front();
  REQUIRE(std::abs(stood.pitch_rad) > 0.1);
  REQUIRE(std::abs(stood.roll_rad) > 0.05);
  REQUIRE(std::abs(stood.roll_rad - stood.pitch_rad) > 0.05);
  CHECK(first.x_m == stood.x_m);
  CHECK(first.y_m == stood.y_m);
  CHECK(first.z_m == stood.z_m);
  CHECK(first.roll_rad == stood.roll_rad);
  CHECK(first.pitch_rad == stood.pitch_rad);
  CHECK(first.yaw_rad == stood.yaw_rad);
  CHECK(first.yaw_rad == Approx(0.6).margin(0.05));
}

TEST_CASE("A run has the values of the draw of its seed") {
  experiment::Experiment experiment;
  experiment.waypoints = {{.name = "s"}, {.name = "e", .x_m = 0.3}};
  experiment.ensemble.keys = {"simulation.motor.mismatch"};
  experiment.ensemble.draws = {{0.01}, {0.02}, {0.03}};
  const test::Files none;
  std::set<double> seen;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const SimulatedTrial trial =
        SimulatedTrialOf(experiment, {}, seed, "e.yaml", test::InputsOf(none));
    CHECK(trial.seed == seed);
    CHECK(trial.simulation.motor.mismatch ==
          experiment::DrawnAt(experiment, seed).simulation.motor.mismatch);
    seen.insert(trial.simulation.motor.mismatch);
  }
  CHECK(seen == std::set<double>{0.01, 0.02, 0.03});
}

TEST_CASE("A run begins where its tag is to be, wherever the draw of its seed has the tag") {
  experiment::Experiment experiment;
  experiment.waypoints = {{.name = "s", .x_m = 0.1, .y_m = 0.2, .heading_deg = 90.0},
                          {.name = "e", .x_m = 0.1, .y_m = 0.5}};
  experiment.ensemble.keys = {"simulation.mocap.tag_ahead_m"};
  experiment.ensemble.draws = {{0.08}, {-0.06}};
  experiment.reference.kind = experiment::ReferenceKind::kNominal;
  const test::Files none;
  Evaluator evaluator(experiment, "e.yaml", test::InputsOf(none));
  std::set<double> seen;
  const auto begins_m = [&](const TrialRequest& request) {
    const SimulatedTrial trial = evaluator.TrialFor(request, {});
    seen.insert(trial.simulation.mocap.tag_ahead_m);
    return (trial.start * geometry::Pose2{trial.simulation.mocap.tag_ahead_m, 0.0, 0.0}).Position();
  };
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    INFO(seed);
    CHECK((begins_m({.seed = seed}) - Eigen::Vector2d(0.1, 0.2)).norm() < 1e-12);
    const Recording nominal = evaluator.Reference({.seed = seed});
    REQUIRE_FALSE(nominal.trajectory.poses.empty());
    CHECK((nominal.trajectory.poses.front().Position() - Eigen::Vector2d(0.1, 0.2)).norm() < 0.02);
  }
  CHECK(seen == std::set<double>{-0.06, 0.08});

  experiment.start = experiment::Start::kReference;
  experiment.reference.kind = experiment::ReferenceKind::kLogs;
  experiment.reference.path.text = "log.csv";
  const Evaluator of_logs(experiment, "e.yaml", test::InputsOf(none));
  Recording log;
  log.trajectory.poses = {{.t_s = 0.0, .x_m = 0.3, .y_m = 0.4, .yaw_rad = 1.0},
                          {.t_s = 1.0, .x_m = 0.5, .y_m = 0.4, .yaw_rad = 1.0}};
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    INFO(seed);
    const SimulatedTrial trial = of_logs.TrialFor({.seed = seed}, log);
    const geometry::Pose2 tag =
        trial.start * geometry::Pose2{trial.simulation.mocap.tag_ahead_m, 0.0, 0.0};
    CHECK((tag.Position() - Eigen::Vector2d(0.3, 0.4)).norm() < 1e-12);
  }
}

TEST_CASE("A robot is found where it stood, however many pictures mirror its tag") {
  SimulatedTrial trial{
      .task = std::vector<control::Waypoint>{{.name = "s"}, {.name = "e", .x_m = 0.05}}};
  simulation::MocapOptions& mocap = trial.simulation.mocap;
  mocap.tag_ahead_m = -0.03;
  mocap.ambiguity = {
      .share = 0.8, .reach_m = 1.0, .camera_x_m = 0.25, .camera_y_m = 0.1, .nearer = 0.005};
  trial.trial.timeout_s = 1.5;
  int all = 0, some = 0;
  for (trial.seed = 1; trial.seed <= 30; ++trial.seed) {
    CAPTURE(trial.seed);
    const trajectory::Trajectory log = Simulate(trial).result.trajectory;
    const geometry::Pose2 start = StartFromLog(log, 0.0, mocap);
    CHECK(std::abs(start.x_m) < 0.002);
    CHECK(std::abs(start.y_m) < 0.002);
    CHECK(std::abs(start.yaw_rad) < 0.012);  // mirrored pictures turn it by 0.06
    int mirrored = 0, rows = 0;
    for (const trajectory::StampedPose& pose : log.poses) {
      if (std::hypot(pose.x_m - log.poses[0].x_m, pose.y_m - log.poses[0].y_m) > 0.01) break;
      mirrored += std::abs(pose.pitch_rad) > 0.3 ? 1 : 0;
      ++rows;
    }
    all += mirrored == rows;
    some += mirrored > 0 && mirrored < rows;
  }
  CHECK(all > 5);
  CHECK(some > 5);
}

}  // namespace
}  // namespace rift::sweep
