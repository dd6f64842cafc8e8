#include "identification/planted.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <random>

#include "rift/config/set_value.hpp"
#include "rift/control/waypoint.hpp"
#include "rift/sweep/simulated_trial.hpp"

namespace rift::test {
namespace {

GridStudy RobotAt(const GridStudy& robot, const std::vector<Planted>& planted,
                  const std::vector<double>& values) {
  std::vector<config::KeyValue> pairs;
  for (size_t i = 0; i < planted.size(); ++i) {
    pairs.push_back({planted[i].key, config::Node::Scalar(fmt::format("{}", values[i]))});
  }
  GridStudy at = robot;
  config::SetValues(at, pairs);
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
  sweep::SimulatedTrial trial{.waypoints = robot.waypoints,
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
          {"simulation.terrain.surfaces.parchment.mu", 0.04, 0.30, 0.20, between(0.07, 0.13)},
          {"simulation.terrain.surfaces.bump.mu", 0.5, 1.2, 0.85, 0.85, true}};
}

sweep::Calibration FindPlanted(const GridStudy& robot, const std::vector<Planted>& planted,
                               std::uint64_t repeat, int logs,
                               const sweep::CalibrationOptions& options, int threads) {
  std::vector<double> truth;
  std::vector<sweep::FreeParameter> free;
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
    recorded.push_back(
        {fmt::format("log {}", i), fmt::format("{}", v_min.back()), run.result.trajectory});
  }
  const sweep::TwinAt twin = [&](size_t log, const std::vector<double>& values) {
    const GridStudy at = RobotAt(robot, planted, values);
    const geometry::Pose2 tag{at.simulation.mocap.tag_ahead_m, 0.0, 0.0};
    return TrialOf(at, v_min[log],
                   trajectory::StandingPose(recorded[log].log) * geometry::Inverse(tag),
                   7 + 1000 * static_cast<std::uint64_t>(log));
  };
  std::mt19937_64 generator(1);
  return sweep::Calibrate(free, recorded, twin, options, generator, threads);
}

}  // namespace rift::test
namespace rift::test {
void Probe(const GridStudy& robot, const std::vector<Planted>& planted, std::uint64_t repeat, int logs, int phases) {
  std::vector<double> truth;
  for (const Planted& p : planted) truth.push_back(p.truth);
  const GridStudy real = RobotAt(robot, planted, truth);
  std::mt19937_64 random(1000 + repeat);
  for (int frames : {1, 3, 5}) {
  random.seed(1000 + repeat);
  double n = 0, a = 0, l = 0, t = 0, t2 = 0, logn = 0, lt=0, lt2=0, yt=0;
  for (int i = 0; i < logs; ++i) {
    const double v = i % 2 == 0 ? 0.15 : 0.20;
    const std::uint64_t seed = random();
    const auto run = sweep::Simulate(TrialOf(real, v, PutDown(real, random), seed));
    const auto& log = run.result.trajectory;
    const geometry::Pose2 tag{real.simulation.mocap.tag_ahead_m, 0.0, 0.0};
    auto twin = TrialOf(real, v, trajectory::StandingPose(log) * geometry::Inverse(tag), getenv("SAMESEED") ? seed : 7 + 1000 * i);
    sweep::ShortHorizonOptions o; o.phases = phases;
    double s = 0, c = 0;
    for (const auto& e : sweep::ShortHorizonErrors(twin, log, o)) {
      if (e.frames != frames) continue;
      ++n; ++c; a += e.ahead_m; l += e.left_m; t += e.turned_rad; t2 += e.turned_rad * e.turned_rad; s += e.turned_rad;
    }
    lt += s / c; lt2 += s / c * s / c; ++logn; yt += log.poses.back().yaw_rad - log.poses.front().yaw_rad;
  }
  fmt::print("  frames {}: ahead {:.3f} mm left {:.3f} mm turned {:.4f} deg (se over logs {:.4f}) rms {:.3f} deg; net turn {:.3f}\n", frames, 1e3 * a / n, 1e3 * l / n,
             57.3 * t / n, 57.3 * std::sqrt((lt2 / logn - lt / logn * lt / logn) / logn), 57.3 * std::sqrt(t2 / n), yt / logn);
  }
}
}
