#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "rift/experiment/experiment.hpp"
#include "rift/experiment/space_yaml.hpp"
#include "rift/sweep/falsify/simulated_trial.hpp"
#include "support/inputs/random_fill.hpp"

namespace rift::experiment {
namespace {

control::Waypoint RandomWaypoint(std::mt19937_64& random) {
  std::uniform_real_distribution<double> place_m(-0.5, 0.5), heading_deg(-180.0, 180.0);
  return {.name = "w",
          .x_m = place_m(random),
          .y_m = place_m(random),
          .heading_deg = heading_deg(random),
          .stop = random() % 2 == 0};
}

/// Any valid values, but for a short trial: a hang would be found and 500 of them are enough work.
sweep::SimulatedTrial RandomTrial(std::mt19937_64& random) {
  sweep::SimulatedTrial trial;
  test::RandomFill(trial.control, random);
  test::RandomFill(trial.trial, random);
  test::RandomFill(trial.simulation, random);
  trial.trial.timeout_s = std::min(trial.trial.timeout_s, 0.5);
  trial.trial.settle_s = std::min(trial.trial.settle_s, 0.1);
  trial.trial.control_period_s = std::clamp(trial.trial.control_period_s, 0.01, 0.1);
  trial.simulation.step_s = std::max(trial.simulation.step_s, 0.001);
  for (size_t i = 2 + random() % 3; i > 0; --i)
    trial.task.waypoints.push_back(RandomWaypoint(random));
  trial.start = trial.task.Start();
  trial.seed = random();
  simulation::HeightImage image{.columns = 8, .rows = 6};
  for (int i = 0; i < 48; ++i) image.samples.push_back(static_cast<double>(random() % 256) / 255.0);
  trial.image = std::make_shared<const simulation::HeightImage>(image);
  return trial;
}

bool IsFinite(const trajectory::Trajectory& trajectory) {
  return std::all_of(trajectory.poses.begin(), trajectory.poses.end(), [](const auto& pose) {
    return std::isfinite(pose.t_s + pose.x_m + pose.y_m + pose.z_m + pose.roll_rad +
                         pose.pitch_rad + pose.yaw_rad);
  });
}

TEST_CASE("Five hundred random valid experiments neither crash nor hang nor log nonsense") {
  std::mt19937_64 random(3);
  int refused = 0, drove = 0;
  for (int i = 0; i < 500; ++i) {
    const sweep::SimulatedTrial trial = RandomTrial(random);
    INFO("experiment " << i);
    try {
      const sweep::SimulatedRun run = sweep::Simulate(trial);
      drove += run.truth.poses.size() > 1;
      REQUIRE(IsFinite(run.truth));
      REQUIRE(IsFinite(run.result.trajectory));
      REQUIRE_FALSE(run.result.reason.empty());
      for (const trial::SentCommand& command : run.result.commands) {
        REQUIRE(std::abs(command.power.left) <= 1.0);
        REQUIRE(std::abs(command.power.right) <= 1.0);
      }
    } catch (const std::invalid_argument&) {  // a start beyond the edge of the table
      ++refused;
    }
  }
  CHECK(refused < 75);
  CHECK(drove > 375);
}

}  // namespace
}  // namespace rift::experiment
