#include "identification/planted.hpp"

#include <fmt/format.h>

#include <random>

#include "rift/control/waypoint.hpp"
#include "rift/sweep/falsify/simulated_trial.hpp"
#include "rift/trajectory/frame_grid.hpp"
#include "rift/yaml/bind.hpp"

namespace rift::test {
namespace {

GridStudy RobotAt(const GridStudy& robot, const std::vector<Planted>& planted,
                  const std::vector<double>& values) {
  std::vector<yaml::KeyValue> pairs;
  for (size_t i = 0; i < planted.size(); ++i) {
    pairs.push_back({planted[i].key, yaml::Node::Scalar(fmt::format("{}", values[i]))});
  }
  GridStudy at = robot;
  yaml::SetValues(at, pairs);
  return at;
}

geometry::Pose2 PutDown(const GridStudy& robot, std::mt19937_64& random) {
  std::normal_distribution<double> aside_m(0.0, 0.02), turned_rad(0.0, 0.06);
  geometry::Pose2 start = control::StartPose(robot.waypoints);
  start.x_m += aside_m(random);
  start.y_m += aside_m(random);
  start.yaw_rad += turned_rad(random);
  return start;
}

sweep::SimulatedTrial TrialOf(const GridStudy& robot, double v_min, const geometry::Pose2& start,
                              std::uint64_t seed) {
  sweep::SimulatedTrial trial{.task = robot.waypoints,
                              .control = robot.control,
                              .trial = robot.trial,
                              .simulation = robot.simulation,
                              .start = start,
                              .seed = seed};
  trial.control.v_min = v_min;
  trial.simulation.terrain.surface = "parchment";
  return trial;
}

}  // namespace

std::vector<Planted> PlantAt(std::uint64_t repeat) {
  std::mt19937_64 random(repeat);
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  return {{"simulation.link.delay_s", 0.02, 0.20, 0.06, between(0.08, 0.14)},
          {"simulation.motor.mismatch", -0.10, 0.10, 0.0, between(-0.06, 0.06)},
          {"simulation.terrain.surfaces.parchment.caster_factor", 0.0, 3.0, 1.0, between(1.0, 2.0)},
          {"simulation.terrain.surfaces.bump.mu", 0.5, 1.2, 0.85, 0.85, true}};
}

sweep::Calibration FindPlanted(const GridStudy& robot, const std::vector<Planted>& planted,
                               std::uint64_t repeat, int logs,
                               const sweep::CalibrationOptions& options, int threads) {
  std::vector<double> truth;
  std::vector<experiment::FreeParameter> free;
  for (const Planted& p : planted) {
    truth.push_back(p.truth);
    free.push_back({p.key, p.min, p.max, p.start});
  }
  const GridStudy real = RobotAt(robot, planted, truth);
  std::mt19937_64 random(1000 + repeat);
  std::vector<sweep::CalibrationLog> recorded;
  std::vector<double> v_min;
  for (int i = 0; i < logs; ++i) {
    v_min.push_back(i % 2 == 0 ? 0.15 : 0.20);
    const std::uint64_t seed = random();
    const auto run = sweep::Simulate(TrialOf(real, v_min.back(), PutDown(real, random), seed));
    // As configs/calibrate.yaml reads logs of this host.
    constexpr double kGrid_fps = 30.0;
    recorded.push_back({.name = fmt::format("log {}", i),
                        .setting = fmt::format("{}", v_min.back()),
                        .log = trajectory::OnFramesOf(run.result.trajectory, kGrid_fps),
                        .drives_grid_fps = kGrid_fps});
  }
  const sweep::TwinAt twin = [&](size_t log, const std::vector<double>& values) {
    const GridStudy at = RobotAt(robot, planted, values);
    return TrialOf(at, v_min[log], sweep::StartFromLog(recorded[log].log, 0.0, at.simulation.mocap),
                   7 + 1000 * static_cast<std::uint64_t>(log));
  };
  std::mt19937_64 generator(1);
  return sweep::Calibrate(free, recorded, twin, options, generator, threads);
}

}  // namespace rift::test
