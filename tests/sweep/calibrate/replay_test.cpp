// How a log is replayed: on its clock, to its end, whatever the twin's own trial would have met.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "rift/geometry/pose2.hpp"
#include "rift/statistics/random.hpp"
#include "rift/sweep/calibrate/short_horizon.hpp"

namespace rift::sweep {
namespace {

using trajectory::Trajectory;

/// A short way, seen after 50 ms: half of the exposure and the processing.
SimulatedTrial Short() {
  SimulatedTrial trial{
      .task = std::vector<control::Waypoint>{{.name = "a"}, {.name = "b", .x_m = 0.25}}, .seed = 5};
  trial.simulation.mocap.exposure_s = 0.02;
  trial.simulation.mocap.processing_s = 0.04;
  return trial;
}

const Trajectory& Log() {
  static const Trajectory log = Simulate(Short()).result.trajectory;
  return log;
}

TEST_CASE("Stamps of a replay are as old as those of the host whose log it is, by its own turns") {
  Trajectory log = Log();  // a row every 50 ms, give or take the jitter of its stamps
  const auto first_s = [&](std::optional<double> host_period_s, double rate_hz) {
    SimulatedTrial twin = Short();
    twin.simulation.mocap.host_period_s = host_period_s;
    twin.simulation.mocap.rate_hz = rate_hz;
    twin.simulation.terrain.surfaces.at("ground").host_period_s.reset();
    return Replay(twin, log).poses.front().t_s - log.poses.front().t_s;
  };
  CHECK(first_s({}, 20.0) == 0.0);   // stamped when captured
  CHECK(first_s(0.06, 0.0) == 0.0);  // a reading is the pose at that moment
  // Waits for each frame; its first pose came after one turn and what was left of one.
  CHECK(first_s(0.04, 20.0) == Approx(0.05 + 0.04 - 1.5 * 0.04));
  // Two turns of the log less half a frame, whatever other logs of this host take.
  for (const double typical_s : {0.05, 0.06}) {
    CHECK(first_s(typical_s, 20.0) == Approx(0.05 + 2 * 0.05 - 0.025 - 1.5 * 0.05).margin(0.002));
  }
  log.poses.erase(log.poses.begin() + 8);  // a missing row makes no turn longer
  CHECK(first_s(0.06, 20.0) == Approx(0.05 + 2 * 0.05 - 0.025 - 1.5 * 0.05).margin(0.002));
  for (auto& pose : log.poses) pose.t_s *= 1.5;
  CHECK(first_s(0.06, 20.0) == Approx(0.05 + 2 * 0.075 - 0.025 - 1.5 * 0.075).margin(0.002));
}

TEST_CASE("A log that was put on frames is replayed by the stamps as they were logged") {
  Trajectory moved = Log();
  for (size_t i = 0; i < moved.poses.size(); ++i) {
    moved.poses[i].stamp_s = moved.poses[i].t_s;
    moved.poses[i].t_s += i % 2 == 0 ? 0.012 : -0.011;
  }
  const Trajectory path = Replay(Short(), Log()), of_moved = Replay(Short(), moved);
  REQUIRE(of_moved.poses.size() == path.poses.size());
  for (size_t i = 0; i < path.poses.size(); ++i) {
    CHECK(of_moved.poses[i].t_s == path.poses[i].t_s);
    CHECK(of_moved.poses[i].x_m == path.poses[i].x_m);
  }
}

TEST_CASE("A replay hears nothing for as long as the robot of its log did") {
  SimulatedTrial late = Short();
  late.simulation.link.late_share = 1.0;
  late.simulation.link.late_s = 2.0;
  const auto left_s = [](const Trajectory& path) {
    size_t i = 0;
    while (std::hypot(path.poses[i].x_m - path.poses[0].x_m,
                      path.poses[i].y_m - path.poses[0].y_m) < 0.02) {
      ++i;
    }
    return path.poses[i].t_s;
  };
  for (const std::uint64_t seed : {5, 6, 7, 8}) {
    late.seed = seed;
    const Trajectory log = Simulate(late).result.trajectory;
    const double apart_s = left_s(Replay(Short(), log)) - left_s(log);
    INFO("seed " << seed << ", left after " << left_s(log) << " s, replayed " << apart_s
                 << " later");
    CHECK(std::abs(apart_s) < 0.2);
  }
}

TEST_CASE("A replay runs on for a tenth of a second after the last pose of the log has arrived") {
  Trajectory log = Log();
  log.poses.resize(log.poses.size() - 3);       // before it arrives
  for (const double timeout_s : {0.3, 60.0}) {  // of the twin's own trial
    CAPTURE(timeout_s);
    SimulatedTrial twin = Short();
    twin.trial.timeout_s = timeout_s;
    const auto after_s = [&] { return Replay(twin, log).poses.back().t_s - log.poses.back().t_s; };
    CHECK(after_s() > 0.1 + 0.05);
    CHECK(after_s() < 0.1 + 0.05 + 0.021);  // a period of the loop
    // A host stamps what it sees when it has come in.
    twin.simulation.mocap.host_period_s = 0.06;
    twin.simulation.mocap.rate_hz = 20.0;
    twin.simulation.terrain.surfaces.at("ground").host_period_s.reset();
    const double age_s = 0.05 + 2 * 0.05 - 0.025;
    CHECK(after_s() > 0.1 + age_s);
    CHECK(after_s() < 0.1 + age_s + 0.021);
  }
}

TEST_CASE(
    "A replay goes on where the log leaves the arena of the twin's own trial, or begins outside") {
  const Trajectory whole = Replay(Short(), Log());
  SimulatedTrial leaves = Short(), begins = Short();
  leaves.trial.arena.x_max_m = 0.1;
  begins.trial.arena.x_min_m = 0.1;
  for (const SimulatedTrial& twin : {leaves, begins}) {
    const Trajectory path = Replay(twin, Log());
    REQUIRE(path.poses.size() == whole.poses.size());
    CHECK(path.poses.back().x_m == whole.poses.back().x_m);
  }
}

TEST_CASE("A replay goes on behind a gap in the log that is longer than a trial waits for a pose") {
  const SimulatedTrial twin = Short();
  Trajectory log = Log();
  log.poses.resize(log.poses.size() - 3);  // before it arrives
  for (size_t i = log.poses.size() / 2; i < log.poses.size(); ++i) {
    log.poses[i].t_s += 2.0 * twin.trial.lost_after_s;
  }
  const Trajectory path = Replay(twin, log);
  CHECK(path.poses.back().t_s > log.poses.back().t_s + 0.1);
  // It drives again: not the pose at which it stood in the gap.
  const double began_again_s = log.poses[log.poses.size() / 2].t_s;
  const auto stood = std::find_if(path.poses.begin(), path.poses.end(),
                                  [&](const auto& pose) { return pose.t_s >= began_again_s; });
  REQUIRE(stood != path.poses.end());
  CHECK(path.poses.back().x_m > stood->x_m + 0.01);
}

TEST_CASE("A replay does not wait for years where the clock of the log was set") {
  Trajectory log = Log();
  const size_t half = log.poses.size() / 2;
  for (size_t i = half; i < log.poses.size(); ++i) log.poses[i].t_s += 1.7e9;
  const Trajectory path = Replay(Short(), log);
  CHECK(path.poses.back().t_s > log.poses[half - 1].t_s + 60.0);
  CHECK(path.poses.back().t_s < log.poses[half - 1].t_s + 61.0);
}

TEST_CASE("A replay that has arrived when it begins stands for all of its log") {
  SimulatedTrial twin = Short();
  twin.trial.settle_s = 0.0;
  twin.simulation.mocap.exposure_s = twin.simulation.mocap.processing_s = 0.0;
  Trajectory log;
  for (int i = 0; i < 4; ++i) {
    log.poses.push_back({.t_s = 0.05 * i, .x_m = 0.25 + 0.001 * i, .yaw_rad = 0.0});
  }
  REQUIRE(Replay(twin, log).poses.size() == 1);
  const std::vector<HorizonError> errors =
      ShortHorizonErrors(twin, log, {.most_frames = 1, .phases = 1, .moved_m = 0.0});
  REQUIRE(errors.size() == 3);
  for (const HorizonError& error : errors) {
    CHECK(error.ahead_m == Approx(-0.001));
    CHECK(error.left_m == Approx(0.0).margin(1e-12));
    CHECK(error.turned_rad == Approx(0.0).margin(1e-12));
  }
}

TEST_CASE("A connection that stands late is the log's own to tell, not the twin's to draw") {
  constexpr ShortHorizonOptions kHorizon{.most_frames = 2, .phases = 1, .moved_m = 0.02};
  SimulatedTrial late = Short();
  late.simulation.link.late_share = 1.0;
  const auto errors = ShortHorizonErrors(Short(), Log(), kHorizon),
             of_late = ShortHorizonErrors(late, Log(), kHorizon);
  REQUIRE(errors.size() > 10);
  REQUIRE(of_late.size() == errors.size());
  for (size_t i = 0; i < errors.size(); ++i) CHECK(of_late[i].ahead_m == errors[i].ahead_m);
}

TEST_CASE(
    "Of replays in even phases from the log's own offset the likeliest one is the prediction") {
  constexpr int kPhases = 4;
  const auto errors = ShortHorizonErrors(Short(), Log(), {.most_frames = 1, .phases = kPhases});
  REQUIRE(errors.size() > 5);
  const double offset = statistics::CounterRandom(Short().seed, 40).Uniform(0, 0);
  double nearest_m = std::numeric_limits<double>::infinity(), others_m = 0.0;
  for (int i = 0; i < kPhases; ++i) {
    SimulatedTrial one = Short();
    one.seed += static_cast<std::uint64_t>(i);
    one.simulation.link.poll_phase = (i + offset) / kPhases;
    const Trajectory path = Replay(one, Log());
    const auto at = [&path](double t_s) {  // x at a time within the path
      size_t k = 1;
      while (path.poses[k].t_s < t_s) ++k;
      const auto &a = path.poses[k - 1], &b = path.poses[k];
      const double share = (t_s - a.t_s) / (b.t_s - a.t_s);
      const auto between = [share](double from, double to) { return from + share * (to - from); };
      return geometry::Pose2{between(a.x_m, b.x_m), between(a.y_m, b.y_m),
                             between(a.yaw_rad, b.yaw_rad)};
    };
    double apart_m = 0.0;
    for (const HorizonError& error : errors) {
      const auto &from = Log().poses[error.from], &to = Log().poses[error.from + 1];
      const double ahead_m = (geometry::Inverse(at(from.t_s)) * at(to.t_s)).x_m;
      const double logged_m = (geometry::Inverse(from.Planar()) * to.Planar()).x_m;
      apart_m = std::max(apart_m, std::abs(error.ahead_m - (ahead_m - logged_m)));
    }
    nearest_m = std::min(nearest_m, apart_m);
    others_m = std::max(others_m, apart_m);
  }
  CHECK(nearest_m < 1e-6);
  CHECK(others_m > 1e-3);
}

}  // namespace
}  // namespace rift::sweep
