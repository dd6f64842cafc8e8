// configs/robots: every robot drives the paper's task, and says the same of itself everywhere.
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>

#include "rift/experiment/experiment.hpp"
#include "rift/files/files.hpp"
#include "rift/simulation/simulated_robot.hpp"
#include "rift/trial/trial.hpp"
#include "support/tree.hpp"

namespace rift::experiment {
namespace {

std::vector<std::string> RobotFiles() {
  std::vector<std::string> names;
  for (const auto& file :
       std::filesystem::directory_iterator(test::SourceDir() + "/configs/robots")) {
    names.push_back(file.path().filename().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

Experiment PaperTaskOf(const std::string& robot) {
  const std::string task = "/task.yaml";
  return LoadExperiment(task, {}, [&](const std::string& path) {
    if (path != task) return files::ReadFile(path);
    return "include: [" + test::SourceDir() + "/configs/robots/" + robot + ", " +
           test::SourceDir() + "/configs/waypoints/paper.yaml]\n";
  });
}

TEST_CASE("Every robot file drives the paper's waypoints in simulation") {
  REQUIRE(RobotFiles().size() >= 4);
  for (const std::string& robot : RobotFiles()) {
    const Experiment experiment = PaperTaskOf(robot);
    for (const std::uint64_t seed : {1, 2, 3}) {
      INFO(robot << " with seed " << seed);
      simulation::SimulatedRobot simulated(experiment.simulation,
                                           control::StartPose(experiment.waypoints), seed);
      const trial::TrialResult result =
          trial::RunTrial(simulated, TaskOf(experiment), experiment.control, experiment.trial);
      INFO(result.reason);
      CHECK(result.outcome == trial::Outcome::kReached);
    }
  }
}

TEST_CASE("Every robot file says the same to the simulator and to rift drive") {
  for (const std::string& robot : RobotFiles()) {
    if (robot == "3pi_2040.yaml") continue;  // fitted values differ from the data sheet on purpose
    INFO(robot);
    const Experiment experiment = PaperTaskOf(robot);
    const auto& body = experiment.simulation.body;
    const auto& motor = experiment.simulation.motor;
    const auto& odometry = experiment.hardware.odometry;
    CHECK(odometry.drive.wheel_radius_m == Approx(body.wheel_radius_m).margin(1e-4));
    CHECK(odometry.drive.track_m == Approx(body.track_m));
    const double full_rad_s = motor.supply_ratio * motor.NoLoad_rad_s();
    CHECK(odometry.drive.full_power_speed_rad_s == Approx(full_rad_s).epsilon(0.01));
    CHECK(experiment.hardware.stopping.full_power_speed_mps ==
          Approx(full_rad_s * body.wheel_radius_m).epsilon(0.02));
    REQUIRE(experiment.simulation.encoder.counts_per_rev);
    // What makes up for the loop delay predicts this robot, and no other.
    const auto& predicted = experiment.control.latency.drive;
    CHECK(predicted.wheel_radius_m == odometry.drive.wheel_radius_m);
    CHECK(predicted.track_m == odometry.drive.track_m);
    CHECK(predicted.full_power_speed_rad_s == odometry.drive.full_power_speed_rad_s);
    CHECK(odometry.counts_per_wheel_turn == Approx(*experiment.simulation.encoder.counts_per_rev));
    // Level on the floor: the ball reaches down as far as the wheels.
    CHECK(body.caster_below_m + body.caster_radius_m == Approx(body.wheel_radius_m).margin(1e-4));
  }
}

TEST_CASE("The gains of every robot file follow the template's formulas") {
  for (const std::string& robot : RobotFiles()) {
    if (robot == "3pi_2040.yaml")
      continue;  // the authors' gains, whose robot is faster than its data
    INFO(robot);
    const Experiment experiment = PaperTaskOf(robot);
    const auto& control = experiment.control;
    const double full_mps = experiment.hardware.stopping.full_power_speed_mps;
    const double turn_rad_s =
        control.heading.p * 2.0 * full_mps / experiment.hardware.odometry.drive.track_m;
    CHECK(turn_rad_s == Approx(robot == "template.yaml" ? 1.3 : 1.7).epsilon(0.04));
    CHECK(control.heading.d == Approx(0.19 * control.heading.p).epsilon(0.03));
  }
  const Experiment task = PaperTaskOf("template.yaml");
  const auto& shown = task.control;
  CHECK(shown.v_max / shown.distance.p == Approx(0.33).margin(0.005));
  CHECK(shown.v_min / shown.distance.p == Approx(0.17).margin(0.005));
  CHECK(shown.latency.drive.full_power_speed_rad_s ==
        task.hardware.odometry.drive.full_power_speed_rad_s);
  const auto& body = task.simulation.body;
  CHECK(body.com_ahead_m / body.caster_ahead_m == Approx(0.2).margin(0.01));
}

}  // namespace
}  // namespace rift::experiment
