// What is left of the errors when a simulator predicts the next frames of its own logs.
#include "rift/sweep/calibrate/short_horizon.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "rift/sweep/calibrate/error_structure.hpp"
#include "support/inputs/paths.hpp"
#include "sweep/calibrate/fitted_simulator.hpp"
#include "sweep/calibrate/model.hpp"

namespace rift::sweep {
namespace {

using trajectory::Trajectory;

/// A way with a turn, seen exactly and at once, on a robot without noise.
SimulatedTrial Exact() {
  SimulatedTrial trial{
      .task =
          std::vector<control::Waypoint>{
              {.name = "a"}, {.name = "b", .x_m = 0.5}, {.name = "c", .x_m = 0.6, .y_m = 0.4}},
      .seed = 5};
  simulation::MocapOptions& mocap = trial.simulation.mocap;
  mocap.noise_across_m = mocap.noise_along_m = mocap.noise_yaw_rad = 0.0;
  mocap.blur_across_s = mocap.stamp_jitter_s = mocap.blur_yaw_rad_per_mps = 0.0;
  trial.simulation.link.late_share = 0.0;
  return trial;
}

const Trajectory& Log() {
  static const Trajectory log = Simulate(Exact()).result.trajectory;
  return log;
}

constexpr ShortHorizonOptions kHorizon{.most_frames = 3, .phases = 2, .moved_m = 0.05};

TEST_CASE("Motions stand by row and by frames, from where the robot has moved") {
  const Trajectory& log = Log();
  size_t first = 0;
  while ((log.poses[first].Position() - log.poses[0].Position()).norm() < 0.05) ++first;
  const std::vector<HorizonError> errors = ShortHorizonErrors(Exact(), log, kHorizon);
  const size_t rows = log.poses.size();
  REQUIRE(errors.size() == 3 * (rows - first) - 6);
  size_t k = 0;
  for (size_t row = first; row < rows; ++row) {
    for (int frames = 1; frames <= 3 && row + static_cast<size_t>(frames) < rows; ++frames, ++k) {
      CHECK(errors[k].from == row);
      CHECK(errors[k].frames == frames);
    }
  }
  CHECK(k == errors.size());
  CHECK(ShortHorizonErrors(Exact(), log, {.most_frames = 1, .phases = 1, .moved_m = 9.0}).empty());
}

TEST_CASE("A simulator predicts its own log, and a stronger motor drives further ahead") {
  SimulatedTrial twin = Exact();
  const auto mean_of = [&](const Trajectory& log) {
    HorizonError mean;
    const auto errors = ShortHorizonErrors(twin, log, kHorizon);
    for (const HorizonError& one : errors) {
      mean.ahead_m += one.ahead_m / static_cast<double>(errors.size());
      mean.turned_rad += one.turned_rad / static_cast<double>(errors.size());
    }
    return mean;
  };
  const HorizonError own = mean_of(Log());
  CHECK(std::abs(own.ahead_m) < 1e-3);
  // A log that was driven with half of the steps: the simulator is ahead of it.
  Trajectory slow = Log();
  for (auto& pose : slow.poses) pose.x_m *= 0.9, pose.y_m *= 0.9;
  CHECK(mean_of(slow).ahead_m > own.ahead_m + 5e-4);
}

TEST_CASE("A log tells the phase of its robot's listener, and with it the delay of the link") {
  ShortHorizonOptions horizon{.most_frames = 1, .phases = 16, .moved_m = 0.02};
  const auto size = [&](const SimulatedTrial& twin, const Trajectory& log) {
    double sum = 0.0;
    for (const HorizonError& one : ShortHorizonErrors(twin, log, horizon)) {
      sum += std::abs(one.turned_rad);
    }
    return sum;
  };
  for (const double phase : {0.1, 0.4, 0.85}) {
    SimulatedTrial robot = Exact(), other = Exact();
    robot.simulation.link.poll_phase = phase;
    const Trajectory log = Simulate(robot).result.trajectory;
    const double own = size(Exact(), log);
    for (const double apart_s : {-0.03, 0.03}) {
      other.simulation.link.delay_s = Exact().simulation.link.delay_s + apart_s;
      CAPTURE(phase, apart_s, own);
      CHECK(size(other, log) > 1.25 * own);
    }
  }
}

TEST_CASE("The way ratio is one of a simulator's own log, and of a faster robot less") {
  const Trajectory& log = Log();
  CHECK(WayRatio(Exact(), log) == Approx(1.0).margin(0.02));
  SimulatedTrial fast = Exact();
  fast.control.v_min = 0.2;
  CHECK(WayRatio(Exact(), Simulate(fast).result.trajectory) < 0.9);
  Trajectory stands = log;
  for (auto& pose : stands.poses) pose = {.t_s = pose.t_s, .yaw_rad = 0.0};
  CHECK(std::isnan(WayRatio(Exact(), stands)));
}

TEST_CASE("Errors are seen from the logged pose: a log turned in the plane has the same") {
  const auto errors = ShortHorizonErrors(Exact(), Log(), kHorizon);
  SimulatedTrial turned = Exact();
  const geometry::Pose2 by{0.3, -0.2, 1.1};
  std::vector<control::Waypoint> waypoints = turned.task.waypoints;
  for (control::Waypoint& waypoint : waypoints) {
    const geometry::Pose2 at = by * geometry::Pose2{waypoint.x_m, waypoint.y_m, 0.0};
    waypoint.x_m = at.x_m;
    waypoint.y_m = at.y_m;
  }
  turned.task = waypoints;
  turned.start = by * turned.start;
  const auto moved = ShortHorizonErrors(turned, test::Moved(Log(), by), kHorizon);
  REQUIRE(moved.size() == errors.size());
  double apart_m = 0.0, size_m = 0.0;
  for (size_t i = 0; i < errors.size(); ++i) {
    apart_m += std::abs(moved[i].ahead_m - errors[i].ahead_m);
    size_m += std::abs(errors[i].ahead_m);
  }
  CHECK(apart_m < 0.2 * size_m + 1e-6);
}

TEST_CASE("A replay needs the yaw, has the log's clock, and runs to the log's end") {
  Trajectory log = Log();
  for (auto& pose : log.poses) pose.t_s += 100.0;
  const Trajectory path = Replay(Exact(), log);
  CHECK(path.poses.front().t_s == Approx(log.poses.front().t_s).margin(0.1));
  CHECK(path.poses.back().t_s >= log.poses.back().t_s);
  CHECK(path.poses.back().t_s < log.poses.back().t_s + 1.0);
  for (auto& pose : log.poses) pose.yaw_rad = NAN;
  CHECK_THROWS_WITH(ShortHorizonErrors(Exact(), log, kHorizon),
                    "a replay needs the yaw of the log");
}

TEST_CASE("A program of powers is replayed from when its trial began, not from the first picture") {
  SimulatedTrial twin = Exact();
  control::ProgramOptions powers;
  for (const double to_m : {0.3, -0.3}) powers.segments.push_back({.straight_m = to_m});
  twin.task = control::Program(powers, {}, {});
  twin.trial.settle_s = 0.3;  // by when a robot has been seen either way
  const Trajectory run = Simulate(twin).result.trajectory;
  const auto mean_off_m = [&](const Trajectory& log, std::optional<double> began_s) {
    double sum_m = 0.0;
    const auto errors = ShortHorizonErrors(twin, log, kHorizon, began_s);
    for (const HorizonError& one : errors) sum_m += std::abs(one.ahead_m);
    return sum_m / static_cast<double>(errors.size());
  };
  const double own_m = mean_off_m(run, 0.0);
  // A robot under a camera is seen before its trial begins.
  Trajectory log = run;
  log.poses.insert(log.poses.begin(), 3, log.poses.front());
  for (size_t i = 0; i < 3; ++i) log.poses[i].t_s -= 0.05 * static_cast<double>(3 - i);
  for (auto& pose : log.poses) pose.t_s += 100.0;
  CHECK(own_m < 1e-3);
  CHECK(mean_off_m(log, 100.0) == Approx(own_m).margin(1e-5));
  CHECK(mean_off_m(log, {}) > 3.0 * own_m);
}

TEST_CASE("The path of a replay is that of the tag, ahead of the axle") {
  SimulatedTrial ahead = Exact();
  ahead.simulation.mocap.tag_ahead_m = 0.04;
  CHECK(Replay(ahead, Log()).poses.front().x_m == Approx(0.04).margin(1e-3));
  ahead.start.yaw_rad = std::numbers::pi / 2.0;
  CHECK(Replay(ahead, Log()).poses.front().y_m == Approx(0.04).margin(1e-3));
}

TEST_CASE("The structure of errors is the mean and size of each kind over the longest horizon") {
  SimulatedTrial biased = Exact();
  biased.simulation.motor.mismatch = 0.05;
  const std::vector<CalibrationLog> logs{{.name = "1", .log = Log()}};
  const ErrorStructure found = StructureOfErrors(
      logs, [&](size_t, const std::vector<double>&) { return biased; }, {}, kHorizon);
  double n = 0.0, ahead = 0.0, left = 0.0, turned = 0.0, ahead2 = 0.0, left2 = 0.0, turned2 = 0.0,
         span_s = 0.0;
  double to_left = 0.0, lefts = 0.0, to_right = 0.0, rights = 0.0;
  for (const HorizonError& one : ShortHorizonErrors(biased, Log(), kHorizon)) {
    if (one.frames != 3) continue;
    const auto &a = Log().poses[one.from], &b = Log().poses[one.from + 3];
    n += 1.0;
    ahead += one.ahead_m, left += one.left_m, turned += one.turned_rad;
    ahead2 += one.ahead_m * one.ahead_m, left2 += one.left_m * one.left_m;
    turned2 += one.turned_rad * one.turned_rad;
    span_s += b.t_s - a.t_s;
    const bool is_left = b.yaw_rad - a.yaw_rad + one.turned_rad > 0.0;
    (is_left ? to_left : to_right) += one.turned_rad;
    (is_left ? lefts : rights) += 1.0;
  }
  CHECK(found.motions == static_cast<size_t>(n));
  CHECK(found.horizon_s == Approx(span_s / n));
  CHECK(found.ahead_bias_m == Approx(ahead / n));
  CHECK(found.left_bias_m == Approx(left / n));
  CHECK(found.turned_bias_rad == Approx(turned / n));
  CHECK(found.ahead_m == Approx(std::sqrt(ahead2 / n)));
  CHECK(found.left_m == Approx(std::sqrt(left2 / n)));
  CHECK(found.turned_rad == Approx(std::sqrt(turned2 / n)));
  CHECK(found.turning_left_rad == Approx(to_left / lefts));
  CHECK(found.turning_right_rad == Approx(to_right / rights));
  CHECK(found.frequency_hz >= 0.2);
  CHECK(found.frequency_hz <= 0.5 / found.horizon_s);
  CHECK(found.frequency_share > 0.0);
  CHECK(found.frequency_share <= 1.0);
  CHECK(StructureOfErrors({}, {}, {}, kHorizon).motions == 0);
  CHECK(std::isnan(StructureOfErrors({}, {}, {}, kHorizon).lag_s));
}

TEST_CASE("A wave of the logged turn is found by its frequency, which is most of the errors") {
  for (const double planted_hz : {0.6, 1.5}) {
    // A robot that goes straight on and never steers; it is the log that turns to and fro.
    SimulatedTrial straight = Exact();
    straight.task = std::vector<control::Waypoint>{{.name = "a"}, {.name = "b", .x_m = 2.0}};
    straight.control.heading = {0.0, 0.0, 0.0};
    straight.control.w_min = 0.0;
    Trajectory log = Simulate(straight).result.trajectory;
    for (auto& pose : log.poses) {
      pose.yaw_rad += 0.1 * std::sin(2.0 * std::numbers::pi * planted_hz * pose.t_s);
    }
    const std::vector<CalibrationLog> logs{{.name = "1", .log = log}};
    const ErrorStructure found = StructureOfErrors(
        logs, [&](size_t, const std::vector<double>&) { return straight; }, {}, kHorizon);
    INFO(planted_hz << " Hz, over " << found.motions << " motions of " << found.horizon_s << " s");
    CHECK(found.frequency_hz == Approx(planted_hz).margin(0.051));  // a step of the search
    CHECK(found.frequency_share > 0.9);
    // The chord of the sine over the horizon.
    CHECK(found.turned_rad ==
          Approx(0.1 * std::sqrt(2.0) * std::sin(std::numbers::pi * planted_hz * found.horizon_s))
              .epsilon(0.05));
  }
}

TEST_CASE("A simulator whose radio is slower turns after the robot, by what its radio takes") {
  const auto lag_s = [](double simulated_s, double logged_s) {
    std::vector<CalibrationLog> logs;
    for (const std::uint64_t seed : {1, 2, 3}) {
      SimulatedTrial robot = Exact();
      robot.task = std::vector<control::Waypoint>{{.name = "a"}, {.name = "b", .x_m = 2.0}};
      robot.seed = seed;
      robot.start.yaw_rad = 0.3;
      robot.simulation.link.delay_s = logged_s;
      logs.push_back({.name = std::to_string(seed), .log = Simulate(robot).result.trajectory});
    }
    const auto twin = [&](size_t, const std::vector<double>&) {
      SimulatedTrial trial = Exact();
      trial.task = std::vector<control::Waypoint>{{.name = "a"}, {.name = "b", .x_m = 2.0}};
      trial.start.yaw_rad = 0.3;
      trial.simulation.link.delay_s = simulated_s;
      return trial;
    };
    return StructureOfErrors(logs, twin, {}, kHorizon).lag_s;
  };
  CHECK(lag_s(0.15, 0.05) == Approx(0.1).margin(0.03));
  CHECK(lag_s(0.05, 0.15) == Approx(-0.1).margin(0.03));
  CHECK(lag_s(0.05, 0.05) == Approx(0.0).margin(0.011));
  CHECK(lag_s(0.45, 0.05) == Approx(0.3));  // later than is looked at: the end
}

TEST_CASE("A mismatch of the motors to either side turns the simulator to that side") {
  const std::vector<CalibrationLog> logs{{.name = "1", .log = Log()}};
  const auto bias_rad = [&](double mismatch) {
    SimulatedTrial twin = Exact();
    twin.simulation.motor.mismatch = mismatch;
    return StructureOfErrors(
               logs, [&](size_t, const std::vector<double>&) { return twin; }, {}, kHorizon)
        .turned_bias_rad;
  };
  const double none = bias_rad(0.0);
  CHECK(bias_rad(0.08) < none - 0.02);
  CHECK(bias_rad(-0.08) > none + 0.02);
}

TEST_CASE("A simulated twin predicts motions in order, runs with seeds that count up, and traits") {
  const TwinAt twin_at = [&](size_t log, const std::vector<double>& values) {
    SimulatedTrial twin = Exact();
    twin.seed = 100 * (log + 1);
    twin.simulation.motor.mismatch = values[0];
    return twin;
  };
  const std::vector<CalibrationLog> logs{{.name = "1", .log = Log()}, {.name = "2", .log = Log()}};
  CalibrationOptions options;
  options.horizon = {.most_frames = 2, .phases = 1, .moved_m = 0.05};
  options.runs = 2;
  for (const int threads : {1, 2}) {
    SimulatedTwins simulator(twin_at, threads);
    CHECK_FALSE(simulator.HasWholeRunsOnly());
    const std::vector<LogPrediction> predictions = simulator.Predict(logs, {0.02}, options);
    REQUIRE(predictions.size() == 2);
    for (size_t log = 0; log < 2; ++log) {
      const SimulatedTrial twin = twin_at(log, {0.02});
      const auto errors = ShortHorizonErrors(twin, Log(), options.horizon);
      REQUIRE(predictions[log].motions.size() == 3 * static_cast<Eigen::Index>(errors.size()));
      REQUIRE(predictions[log].frames.size() == errors.size());
      for (size_t i = 0; i < errors.size(); ++i) {
        const auto at = 3 * static_cast<Eigen::Index>(i);
        CHECK(predictions[log].motions[at] == errors[i].ahead_m);
        CHECK(predictions[log].motions[at + 1] == errors[i].left_m);
        CHECK(predictions[log].motions[at + 2] == errors[i].turned_rad);
        CHECK(predictions[log].frames[i] == errors[i].frames);
      }
      REQUIRE(predictions[log].runs.size() == 2);
      SimulatedTrial next = twin;
      ++next.seed;
      CHECK(predictions[log].runs[0].poses.back().x_m ==
            Simulate(twin).result.trajectory.poses.back().x_m);
      CHECK(predictions[log].runs[1].poses.back().x_m ==
            Simulate(next).result.trajectory.poses.back().x_m);
    }
    const std::vector<Trajectory> first = simulator.LogsAt(logs, {0.02}, 0),
                                  second = simulator.LogsAt(logs, {0.02}, 1);
    SimulatedTrial made = twin_at(1, {0.02});
    const std::uint64_t seed = made.seed;
    made.seed = SeedInPlace(seed, 0, 0);
    CHECK(first[1].poses.back().x_m == Simulate(made).result.trajectory.poses.back().x_m);
    made.seed = SeedInPlace(seed, 1, 0);
    CHECK(second[1].poses.back().x_m == Simulate(made).result.trajectory.poses.back().x_m);
  }
}

}  // namespace
}  // namespace rift::sweep
