// How a log is replayed: on its clock, to its end, whatever the twin's own trial would have met.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
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

TEST_CASE("Stamps of a replay are as old as those of the host whose log it is") {
  const auto age_s = [](std::optional<double> host_period_s, double rate_hz,
                        std::optional<double> on_surface_s = {}) {
    SimulatedTrial twin = Short();
    twin.simulation.mocap.host_period_s = host_period_s;
    twin.simulation.mocap.rate_hz = rate_hz;
    twin.simulation.terrain.surfaces.at("ground").host_period_s = on_surface_s;
    return Replay(twin, Log()).poses.front().t_s - Log().poses.front().t_s;
  };
  CHECK(age_s({}, 20.0) == 0.0);                    // stamped when captured
  CHECK(age_s(0.06, 0.0) == 0.0);                   // a reading is the pose at that moment
  CHECK(age_s(0.04, 20.0) == Approx(0.05 + 0.04));  // waits for each frame
  CHECK(age_s(0.06, 20.0) == Approx(0.05 + 2 * 0.06 - 0.025));  // two turns less half a frame
  CHECK(age_s(0.05, 20.0) == Approx(0.05 + 2 * 0.05 - 0.025));  // as fast as the camera
  CHECK(age_s(0.06, 20.0, 0.08) == Approx(0.05 + 2 * 0.08 - 0.025));
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
    const double age_s = 0.05 + 2 * 0.06 - 0.025;
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

TEST_CASE("Replays look at the link in even phases from an offset that is the log's own") {
  // Four replays each a quarter of a poll later: their mean is that of single replays, put there.
  constexpr int kPhases = 4;
  const auto errors = ShortHorizonErrors(Short(), Log(), {.most_frames = 1, .phases = kPhases});
  const double offset = statistics::CounterRandom(Short().seed, 40).Uniform(0, 0);
  std::vector<double> mean(errors.size(), 0.0);
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
    for (size_t k = 0; k < errors.size(); ++k) {
      const auto &from = Log().poses[errors[k].from], &to = Log().poses[errors[k].from + 1];
      const double ahead_m = (geometry::Inverse(at(from.t_s)) * at(to.t_s)).x_m;
      const double logged_m = (geometry::Inverse(from.Planar()) * to.Planar()).x_m;
      mean[k] += (ahead_m - logged_m) / kPhases;
    }
  }
  REQUIRE(errors.size() > 5);
  for (size_t k = 0; k < errors.size(); ++k)
    CHECK(errors[k].ahead_m == Approx(mean[k]).margin(1e-9));
}

}  // namespace
}  // namespace rift::sweep
