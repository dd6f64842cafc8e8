// A row of features: those of the drive, how it steers, and on which side each waypoint was passed.
#include "sweep/calibrate/feature_model.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "rift/sweep/calibrate/drive_features.hpp"
#include "rift/sweep/calibrate/repeated_trial.hpp"
#include "rift/trial/loop_delay.hpp"
#include "support/mirror.hpp"

namespace rift::sweep {
namespace {

using control::Waypoint;

/// One row for each waypoint but the first, `left_m` beside it, seen from the one before.
struct Drive {
  explicit Drive(std::vector<Waypoint> waypoints) { twin.task.waypoints = std::move(waypoints); }

  void Pass(size_t waypoint, double left_m) {
    const Eigen::Vector2d from = twin.task.waypoints[waypoint - 1].Position();
    const Eigen::Vector2d to = twin.task.waypoints[waypoint].Position();
    const Eigen::Vector2d ahead = (to - from).normalized();
    const Eigen::Vector2d at = to + left_m * Eigen::Vector2d(-ahead.y(), ahead.x());
    path.poses.push_back({.t_s = 0.05 * static_cast<double>(path.poses.size()),
                          .x_m = at.x(),
                          .y_m = at.y(),
                          .target_x_m = to.x(),
                          .target_y_m = to.y()});
  }
  std::vector<double> Sides() const {
    const Eigen::VectorXd row = FeatureRow(path, twin);
    const auto count = static_cast<Eigen::Index>(twin.task.waypoints.size()) - 1;
    return {row.end() - count, row.end()};
  }

  SimulatedTrial twin;
  trajectory::Trajectory path;
};

TEST_CASE("A waypoint is passed to the left or to the right of the way there, by the last row") {
  test::OnBothSides("left", "right", [](const test::Side& side) {
    const double sign = side.IsFirst() ? 1.0 : -1.0;
    Drive drive({{.name = "a"}, {.name = "b", .x_m = 1.0}, {.name = "c", .x_m = 1.0, .y_m = 1.0}});
    drive.Pass(1, 0.3);
    drive.Pass(1, sign * 0.02);
    drive.Pass(2, -sign * 0.01);
    const std::vector<double> sides = drive.Sides();
    CHECK(sides[0] == Approx(sign * 0.02));
    CHECK(sides[1] == Approx(-sign * 0.01));
  });
}

TEST_CASE("A place that is driven to twice is passed twice, each time from where the robot came") {
  Drive drive({{.name = "a"},
               {.name = "b", .x_m = 1.0},
               {.name = "c", .x_m = 1.0, .y_m = 1.0},
               {.name = "b again", .x_m = 1.0}});
  drive.Pass(1, 0.01);
  drive.Pass(2, 0.02);
  CHECK(std::isnan(drive.Sides()[2]));
  drive.Pass(3, -0.03);
  const std::vector<double> sides = drive.Sides();
  CHECK(sides[0] == Approx(0.01));
  CHECK(sides[1] == Approx(0.02));
  CHECK(sides[2] == Approx(-0.03));
}

TEST_CASE("Waypoints close to each other are two places") {
  Drive drive({{.name = "a"}, {.name = "b", .x_m = 1.0}, {.name = "c", .x_m = 1.01}});
  drive.Pass(1, 0.01);
  drive.Pass(2, 0.02);
  CHECK(drive.Sides()[0] == Approx(0.01));
  CHECK(drive.Sides()[1] == Approx(0.02));
}

/// A way with a turn for the simulated robot.
SimulatedTrial Turn(double mismatch) {
  SimulatedTrial twin{.task = std::vector<Waypoint>{{.name = "a"},
                                                    {.name = "b", .x_m = 0.4},
                                                    {.name = "c", .x_m = 0.4, .y_m = 0.3}},
                      .seed = 3};
  twin.simulation.motor.mismatch = mismatch;
  return twin;
}

bool IsSame(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  return a.size() == b.size() &&
         ((a.array() == b.array()) || (a.array().isNaN() && b.array().isNaN())).all();
}

TEST_CASE(
    "A row has the features that look at no stamps, in their order, then lag, gain and bias") {
  const SimulatedTrial twin = Turn(0.05);
  const trajectory::Trajectory log = Simulate(twin).result.trajectory;
  std::vector<double> expected;
  const std::vector<double> all = FeaturesOf(log, {});
  for (size_t i = 0; i < all.size(); ++i) {
    if (!DriveFeatures()[i].is_timing) expected.push_back(all[i]);
  }
  const trial::LoopDelay delay = trial::EstimateLoopDelay(log, twin.task.waypoints, twin.control);
  REQUIRE(delay.lag_s >= 0.0);
  for (const double one : {delay.lag_s, delay.gain_rad_s, delay.bias_rad_s})
    expected.push_back(one);
  const Eigen::VectorXd row = FeatureRow(log, twin);
  REQUIRE(row.size() == static_cast<Eigen::Index>(expected.size()) + 2);
  CHECK(IsSame(row.head(row.size() - 2),
               Eigen::Map<const Eigen::VectorXd>(expected.data(), row.size() - 2)));
  CHECK(std::isfinite(row[row.size() - 1]));

  // What hardly drove tells no lag, and nothing instead of one.
  trajectory::Trajectory brief = log;
  brief.poses.resize(3);
  const Eigen::VectorXd none = FeatureRow(brief, twin);
  for (Eigen::Index k = 3; k < 6; ++k) CHECK(std::isnan(none[none.size() - k]));
}

TEST_CASE("Sets of values that are driven alike share their noise, which no other round has") {
  const TwinAt twin = [](size_t log, const std::vector<double>& values) {
    SimulatedTrial one = Turn(values[0]);
    one.seed += log;
    return one;
  };
  const std::vector<CalibrationLog> logs(2);
  const std::vector<std::vector<double>> values(5, {0.02});
  const std::vector<FeatureRows> driven = DriveAt(values, logs, twin, 1, 2, 1);
  const auto row = [](const std::vector<FeatureRows>& of, size_t set, int log) -> Eigen::VectorXd {
    return of[set].rows.row(log);
  };
  REQUIRE(driven.size() == 5);
  CHECK(driven[0].rows.rows() == 2);
  for (const int log : {0, 1}) {
    CHECK(IsSame(row(driven, 0, log), row(driven, 1, log)));
    CHECK(IsSame(row(driven, 2, log), row(driven, 3, log)));
    CHECK_FALSE(IsSame(row(driven, 1, log), row(driven, 2, log)));
    CHECK_FALSE(IsSame(row(driven, 3, log), row(driven, 4, log)));
    CHECK(driven[0].has_failed[log] == 0.0);
  }
  CHECK_FALSE(IsSame(row(driven, 0, 0), row(driven, 0, 1)));
  const std::vector<FeatureRows> next = DriveAt(values, logs, twin, 2, 2, 1);
  for (const size_t set : {0, 2, 4}) {
    for (const size_t of_next : {0, 2, 4}) {
      CHECK_FALSE(IsSame(row(next, of_next, 0), row(driven, set, 0)));
    }
  }
  const std::vector<FeatureRows> again = DriveAt(values, logs, twin, 1, 2, 3);
  for (size_t i = 0; i < 5; ++i) CHECK(IsSame(row(again, i, 1), row(driven, i, 1)));
  // The values are those of the set.
  const FeatureRows other = DriveAt({{0.02}, {0.06}}, logs, twin, 1, 2, 1)[1];
  CHECK_FALSE(IsSame(other.rows.row(0), row(driven, 1, 0)));
}

TEST_CASE("A drive on a detour, or one that does not arrive, has failed and tells nothing else") {
  const TwinAt twin = [](size_t log, const std::vector<double>&) {
    SimulatedTrial one = Turn(0.0);
    one.simulation.mocap.rate_hz = 30.0;
    one.simulation.mocap.host_period_s = 0.053;
    if (log == 2) one.trial.timeout_s = 1.0;
    return one;
  };
  std::vector<CalibrationLog> logs(4);
  logs[1].longest_m = 0.5;  // the way is 0.7 m
  logs[3].drives_grid_fps = 30.0;
  const FeatureRows at = DriveAt({{0.0}}, logs, twin, 0, 1, 1)[0];
  CHECK(at.has_failed == Eigen::Vector4d(0.0, 1.0, 1.0, 0.0));
  CHECK(at.rows.row(1).array().isNaN().all());
  CHECK(at.rows.row(2).array().isNaN().all());
  CHECK_FALSE(at.rows.row(0).array().isNaN().all());
  CHECK_FALSE(IsSame(at.rows.row(0), at.rows.row(3)));  // stamps that are put on frames
}

TEST_CASE("A drive as long as a log may be is no detour, and one that is longer is") {
  const TwinAt twin = [](size_t, const std::vector<double>&) {
    SimulatedTrial one = Turn(0.0);
    simulation::MocapOptions& mocap = one.simulation.mocap;
    mocap.noise_across_m = mocap.noise_along_m = mocap.noise_yaw_rad = 0.0;
    mocap.blur_across_s = mocap.stamp_jitter_s = mocap.blur_yaw_rad_per_mps = 0.0;
    mocap.rate_hz = mocap.frame_jitter_s = mocap.host_jitter_s = 0.0;
    one.simulation.link.poll_s = 0.0;
    return one;
  };
  // Nothing is left to chance: the length of any seed is that of the drive.
  std::vector<double> lengths_m;
  for (const std::uint64_t seed : {3, 4, 5}) {
    SimulatedTrial one = twin(0, {});
    one.seed = seed;
    lengths_m.push_back(LengthByStrides_m(Simulate(one).result.trajectory));
  }
  REQUIRE(lengths_m[0] == lengths_m[1]);
  REQUIRE(lengths_m[0] == lengths_m[2]);
  std::vector<CalibrationLog> logs(2);
  logs[0].longest_m = lengths_m[0];
  logs[1].longest_m = std::nextafter(lengths_m[0], 0.0);
  CHECK(DriveAt({{0.0}}, logs, twin, 0, 1, 1)[0].has_failed == Eigen::Vector2d(0.0, 1.0));
}

}  // namespace
}  // namespace rift::sweep
