// rift's own simulator as a fit sees it: traits of whole runs, logs that it makes itself, and when
// the trials of both began.
#include <catch2/catch.hpp>
#include <cmath>
#include <optional>
#include <random>
#include <vector>

#include "rift/control/navigator.hpp"
#include "rift/gap/likeness.hpp"
#include "rift/sweep/calibrate/error_structure.hpp"
#include "rift/sweep/calibrate/likeness.hpp"
#include "rift/trajectory/frame_grid.hpp"
#include "rift/trial/loop_delay.hpp"
#include "sweep/calibrate/feature_model.hpp"
#include "sweep/calibrate/fitted_simulator.hpp"
#include "sweep/calibrate/model.hpp"

namespace rift::sweep {
namespace {

using trajectory::Trajectory;

/// A way with a turn.
SimulatedTrial Turn() {
  return {.task =
              std::vector<control::Waypoint>{
                  {.name = "a"}, {.name = "b", .x_m = 0.4}, {.name = "c", .x_m = 0.5, .y_m = 0.3}},
          .seed = 11};
}

TEST_CASE("Traits are the mean weave, speed, lag and gain of the runs that arrive, and of a log") {
  SimulatedTrial twin = Turn();
  const TwinAt twin_at = [&twin](size_t log, const std::vector<double>&) {
    SimulatedTrial one = twin;
    if (log == 1) one.control.heading.p *= 0.5;
    return one;
  };
  SimulatedTwins simulator(twin_at, 1);
  const auto expected = [](const Trajectory& path, const SimulatedTrial& of) {
    const gap::PathTraits shape = gap::TraitsOf(path, {});
    const trial::LoopDelay delay = trial::EstimateLoopDelay(path, of.task.waypoints, of.control);
    return Eigen::Vector4d(std::log(shape.weave_m), std::log(shape.speed_mps), delay.lag_s,
                           delay.gain_rad_s);
  };
  const Trajectory log = Simulate(twin).result.trajectory;
  Eigen::Vector4d mean = Eigen::Vector4d::Zero();
  for (const std::uint64_t run : {0, 1, 2}) {
    SimulatedTrial one = twin;
    one.seed += run;
    mean += expected(Simulate(one).result.trajectory, one) / 3.0;
  }
  const std::vector<CalibrationLog> logs{{.name = "1", .log = log}};
  CalibrationOptions options;
  options.horizon.phases = 1;
  options.runs = 3;
  const LogPrediction predicted = simulator.Predict(logs, {}, options)[0];
  REQUIRE(predicted.mean_traits);
  for (const Trait k : {kLogWeave, kLogSpeed, kLoopDelay_s, kSteeringGain}) {
    CHECK((*predicted.mean_traits)[k] == Approx(mean[k]));
  }
  for (const size_t of_log : {0, 1}) {
    const Traits traits = simulator.TraitsOf(log, of_log, {});
    REQUIRE(traits);
    const Eigen::Vector4d its_own = expected(log, twin_at(of_log, {}));
    for (const Trait k : {kLogWeave, kLogSpeed, kLoopDelay_s, kSteeringGain}) {
      CHECK((*traits)[k] == Approx(its_own[k]));
    }
  }

  twin.trial.timeout_s = 1.0;  // none of them arrives
  const LogPrediction none = simulator.Predict(logs, {}, options)[0];
  CHECK(none.runs.empty());
  CHECK_FALSE(none.mean_traits);
  CHECK(none.motions.size() == predicted.motions.size());  // a replay goes on to the log's end
}

TEST_CASE("A simulated log that would be longer than its own may be is driven again") {
  const TwinAt twin = [](size_t log, const std::vector<double>&) {
    SimulatedTrial one = Turn();
    one.seed += log;
    return one;
  };
  SimulatedTwins simulator(twin, 1);
  std::vector<CalibrationLog> logs(2);
  logs[1].longest_m = 0.1;  // no run is: the last of ten stands
  const std::vector<Trajectory> made = simulator.LogsAt(logs, {}, 0);
  for (const size_t log : {0, 1}) {
    SimulatedTrial expected = twin(log, {});
    expected.seed = SeedInPlace(expected.seed, 0, log == 0 ? 0 : 9);
    const Trajectory path = Simulate(expected).result.trajectory;
    REQUIRE(made[log].poses.size() == path.poses.size());
    CHECK(made[log].poses.back().x_m == path.poses.back().x_m);
    CHECK(made[log].poses.back().t_s == path.poses.back().t_s);
  }
}

std::vector<double> StampsOf_s(const Trajectory& path) {
  std::vector<double> stamps_s;
  for (const auto& pose : path.poses) stamps_s.push_back(pose.t_s);
  return stamps_s;
}

TEST_CASE("Simulated logs and runs have their stamps on the frames that those of the logs are on") {
  // A loop that stamps the frames of its camera late.
  const TwinAt twin = [](size_t log, const std::vector<double>&) {
    SimulatedTrial one = Turn();
    one.seed += 100 * log;
    one.trial.timeout_s = 8.0;
    one.simulation.mocap.rate_hz = 30.0;
    one.simulation.mocap.host_period_s = 0.053;
    return one;
  };
  SimulatedTwins simulator(twin, 1);
  CalibrationOptions options;
  options.horizon.phases = 1;
  options.runs = 1;
  std::vector<CalibrationLog> logs(4);
  std::vector<SimulatedRun> runs;  // that predict: a log has the seed of the first
  for (size_t i = 0; i < logs.size(); ++i) {
    runs.push_back(Simulate(twin(i, {})));
    logs[i].log = runs[i].result.trajectory;
    logs[i].drives_grid_fps = i == 0 ? 0.0 : 30.0;
  }
  const std::vector<Trajectory> made = simulator.LogsAt(logs, {}, 0);
  const std::vector<LogPrediction> predicted = simulator.Predict(logs, {}, options);
  int moved_logs = 0, moved_runs = 0;
  for (size_t i = 0; i < logs.size(); ++i) {
    const auto on_frames = [&](const Trajectory& path) {
      return StampsOf_s(trajectory::OnFramesOf(path, logs[i].drives_grid_fps));
    };
    const Trajectory as_stamped = RunWithin(logs[i].longest_m, twin(i, {}), 0);
    CHECK(StampsOf_s(made[i]) == on_frames(as_stamped));
    moved_logs += on_frames(as_stamped) != StampsOf_s(as_stamped);
    if (runs[i].result.outcome != trial::Outcome::kReached) continue;
    REQUIRE(predicted[i].runs.size() == 1);
    CHECK(StampsOf_s(predicted[i].runs[0]) == on_frames(logs[i].log));
    moved_runs += on_frames(logs[i].log) != StampsOf_s(logs[i].log);
  }
  CHECK(moved_logs > 0);  // where the grid is found
  CHECK(moved_runs > 0);
}

/// Ahead and back by powers, by the clock of the trial, seen exactly by a camera without delay.
SimulatedTrial Powers(size_t log) {
  control::ProgramOptions powers;
  for (const double to_m : {0.3, -0.3}) powers.segments.push_back({.straight_m = to_m});
  SimulatedTrial trial{.task = control::Program(powers, {}, {}), .seed = 5 + log};
  trial.trial.settle_s = 0.3;
  simulation::MocapOptions& mocap = trial.simulation.mocap;
  mocap.noise_across_m = mocap.noise_along_m = mocap.noise_yaw_rad = 0.0;
  mocap.blur_across_s = mocap.stamp_jitter_s = mocap.blur_yaw_rad_per_mps = 0.0;
  trial.simulation.link.poll_s = 0.0;  // a listener whose phase nobody knows
  return trial;
}

/// Three drives by powers on a clock whose trial began at 100 s, `is_known` or not.
std::vector<CalibrationLog> PowerLogs(bool is_known) {
  std::vector<CalibrationLog> logs;
  for (const size_t i : {0, 1, 2}) {
    CalibrationLog& one = logs.emplace_back();
    one.name = one.setting = std::to_string(i);
    one.log = Simulate(Powers(i)).result.trajectory;
    for (auto& pose : one.log.poses) pose.t_s += 100.0;
    if (is_known) one.began_s = 100.0;
  }
  return logs;
}

constexpr ShortHorizonOptions kHorizon{.most_frames = 3, .phases = 1, .moved_m = 0.02};

TEST_CASE("Powers are replayed from when their trial began, where that is known") {
  const TwinAt twin = [](size_t log, const std::vector<double>&) { return Powers(log); };
  SimulatedTwins simulator(twin, 1);
  CalibrationOptions options;
  options.horizon = kHorizon;
  options.runs = 0;
  const auto predicted = [&](bool is_known) {
    return simulator.Predict(PowerLogs(is_known), {}, options);
  };
  const std::vector<LogPrediction> known = predicted(true), unknown = predicted(false);
  for (const size_t i : {0, 1, 2}) {
    CHECK(known[i].motions.cwiseAbs().maxCoeff() < 1e-3);
    CHECK(unknown[i].motions.norm() > 3.0 * known[i].motions.norm());
  }
  const auto ahead_m = [&](bool is_known) {
    return StructureOfErrors(PowerLogs(is_known), twin, {}, kHorizon).ahead_m;
  };
  CHECK(ahead_m(true) < 5e-4);
  CHECK(ahead_m(false) > 3.0 * ahead_m(true));
}

TEST_CASE("Simulated logs of powers have begun when their own trial did") {
  const TwinAt twin = [](size_t log, const std::vector<double>&) { return Powers(log); };
  SimulatedTwins simulator(twin, 1);
  CalibrationOptions options;
  options.horizon = kHorizon;
  options.runs = 0;
  const std::vector<experiment::FreeParameter> parameters{{.key = "a", .max = 1.0}};
  const Eigen::VectorXd shares = Eigen::VectorXd::Constant(1, 0.5);
  const auto errors = [&](bool is_known) {
    const ErrorModel real(parameters, PowerLogs(is_known), simulator, options, shares);
    double sum = 0.0;
    for (const LogErrors& one : real.OfSimulatedLogs(shares, 0).RawErrorsAt(shares)) {
      sum += one.motions.norm();
    }
    return sum;
  };
  // Of logs whose beginning nobody knows the simulated ones count from their first picture as well.
  CHECK(errors(false) > 3.0 * errors(true));
}

TEST_CASE("A path has traits when its yaw answers the steering, at once as well, and none else") {
  const TwinAt twin = [](size_t, const std::vector<double>&) { return Turn(); };
  SimulatedTwins simulator(twin, 1);
  // A drive whose yaw turns by what is asked at each row until the next one.
  const auto driven = [](double gain_rad_s) {
    const SimulatedTrial of = Turn();
    control::Navigator navigator(of.control, of.task.waypoints);
    Trajectory path;
    trajectory::StampedPose pose{.yaw_rad = 0.0};
    constexpr double kRow_s = 0.05;
    for (int i = 0; i < 90; ++i) {
      path.poses.push_back(pose);
      const control::WheelPower power =
          navigator.Step({pose.t_s, kRow_s, pose.t_s, pose.Planar()}).power;
      navigator.NoteSent(pose.t_s, power);
      pose.t_s += kRow_s;
      pose.x_m += kRow_s * 0.1 * std::cos(pose.yaw_rad);
      pose.y_m += kRow_s * (0.1 * std::sin(pose.yaw_rad) + (i % 2 == 0 ? 0.02 : -0.02));
      pose.yaw_rad += kRow_s * gain_rad_s * (power.right - power.left);
    }
    return path;
  };
  const Traits at_once = simulator.TraitsOf(driven(3.0), 0, {});
  REQUIRE(at_once);
  CHECK((*at_once)[kLoopDelay_s] == 0.0);
  CHECK((*at_once)[kSteeringGain] == Approx(3.0).epsilon(0.02));
  CHECK_FALSE(simulator.TraitsOf(driven(0.0), 0, {}));  // it does not turn at all
  // At once is a delay in the features of a fit and in a likeness as well.
  const SimulatedTrial of = Turn();
  const Eigen::VectorXd row = FeatureRow(driven(3.0), of);
  const Eigen::Index lag = row.size() - 5;  // then gain, bias and the sides of two waypoints
  CHECK(row[lag] == 0.0);
  CHECK(row[lag + 1] == Approx(3.0).epsilon(0.02));
  CHECK(std::isnan(FeatureRow(driven(0.0), of)[lag]));
  const RepeatedTrial trial{.setting = "a",
                            .real = driven(3.0),
                            .runs = {driven(0.0)},
                            .waypoints = of.task.waypoints,
                            .control = of.control};
  gap::LikenessOptions options;
  options.bootstrap.resamples = 20;
  options.shuffles = 19;
  options.classifier.permutations = 0;
  std::mt19937_64 generator(1);
  const DriveLikeness likeness = MeasureDriveLikeness({trial}, true, {}, options, generator);
  CHECK(likeness.loop_delay_s.real == 0.0);
  CHECK(std::isnan(likeness.loop_delay_s.sim));
}

}  // namespace
}  // namespace rift::sweep
