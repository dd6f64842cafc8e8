#include "rift/odometry/program_runs.hpp"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <stdexcept>

#include "rift/geometry/pose2.hpp"
#include "rift/odometry/calibration.hpp"
#include "rift/odometry/readings_during.hpp"

namespace rift::odometry {
namespace {

using trajectory::Trajectory;

/// What a run is made of: the wheels roll `left` and `right` metres a second, and the ground gives
/// them these shares of it.
struct Motion {
  double left_mps = 0.3;
  double right_mps = 0.3;
  double left_grip = 1.0;
  double right_grip = 1.0;
  double seconds = 5.0;
};

RunLog Drive(const Motion& motion) {
  const OdometryOptions wheels;
  RunLog run{.name = "run"};
  geometry::Pose2 at{0.1, 0.2, 0.3};
  double left_m = 0.0, right_m = 0.0;
  constexpr double kStep_s = 0.01, kStands_s = 0.5;
  for (int i = 0; i * kStep_s < motion.seconds + 2.0 * kStands_s; ++i) {
    const double t_s = i * kStep_s;
    const auto counts = [&](double way_m) {
      return static_cast<std::int64_t>(std::floor(way_m / MetresPerCount(wheels)));
    };
    run.encoders.push_back({t_s, {counts(left_m), counts(right_m)}});
    if (i % 5 == 0) {
      run.camera.poses.push_back({.t_s = t_s, .x_m = at.x_m, .y_m = at.y_m, .yaw_rad = at.yaw_rad});
    }
    const bool drives = t_s >= kStands_s && t_s < kStands_s + motion.seconds;
    if (!drives) continue;
    const double left_by = motion.left_mps * kStep_s, right_by = motion.right_mps * kStep_s;
    left_m += left_by;
    right_m += right_by;
    const double left_on = motion.left_grip * left_by, right_on = motion.right_grip * right_by;
    at = at * control::ArcMotion(0.5 * (left_on + right_on),
                                 (right_on - left_on) / wheels.drive.track_m);
  }
  return run;
}

Trajectory Line(double length_m, double aside_m = 0.0) {
  Trajectory path;
  for (int i = 0; i <= 50; ++i) {
    path.poses.push_back({.t_s = 0.1 * i,
                          .x_m = 0.1 + std::cos(0.3) * length_m * i / 50 - std::sin(0.3) * aside_m,
                          .y_m = 0.2 + std::sin(0.3) * length_m * i / 50 + std::cos(0.3) * aside_m,
                          .yaw_rad = 0.3});
  }
  return path;
}

TEST_CASE("A run that rolls has no slip and no drift beyond its counts") {
  const RunMeasures run = MeasureRun(Drive({.right_mps = 0.33}), std::nullopt, {}, {});
  CHECK(run.slip_left == Approx(0.0).margin(0.002));
  CHECK(run.slip_right == Approx(0.0).margin(0.002));
  CHECK(run.odometry_gap_m < 0.002);
  CHECK(std::abs(run.yaw_drift_rad) < 0.01);
  CHECK(std::isnan(run.deviation_m));
}

TEST_CASE("Slip is told for the wheel that slips and along the way") {
  RunLog run = Drive({.left_grip = 0.9, .right_grip = 0.8});
  const RunMeasures both = MeasureRun(run, std::nullopt, {}, {});
  CHECK(both.slip_left == Approx(0.1).margin(0.003));
  CHECK(both.slip_right == Approx(0.2).margin(0.003));
  REQUIRE(both.slip.size() == 20);
  for (const Slip& part : both.slip) {
    CHECK(part.left == Approx(0.1).margin(0.02));
    CHECK(part.right == Approx(0.2).margin(0.02));
  }
  CHECK(both.slip.front().u == Approx(0.025));

  const RunMeasures backwards = MeasureRun(
      Drive({.left_mps = -0.3, .right_mps = -0.3, .left_grip = 0.9}), std::nullopt, {}, {});
  CHECK(backwards.slip_left == Approx(0.1).margin(0.003));
  CHECK(backwards.slip_right == Approx(0.0).margin(0.003));
}

TEST_CASE("A wheel that is dragged has a slip below zero and one that stands has none") {
  const RunMeasures dragged = MeasureRun(Drive({.left_grip = 1.1}), std::nullopt, {}, {});
  CHECK(dragged.slip_left == Approx(-0.1).margin(0.003));
  const RunMeasures pivot = MeasureRun(Drive({.left_mps = 0.0}), std::nullopt, {}, {});
  CHECK(std::isnan(pivot.slip_left));
  CHECK(pivot.slip_right == Approx(0.0).margin(0.003));
}

TEST_CASE("The distance from a program is taken at equal arc length, standing left out") {
  const RunMeasures run = MeasureRun(Drive({}), Line(1.5, 0.04), {}, {});
  CHECK(run.did_move);
  CHECK(run.length_m == Approx(1.5).epsilon(0.01));
  CHECK(run.deviation_m == Approx(0.04).epsilon(0.02));
  CHECK(run.end_error_m == Approx(0.04).epsilon(0.02));
  // At equal u a run of half the length is behind by half of what there is so far.
  const RunMeasures half = MeasureRun(Drive({}), Line(3.0), {}, {});
  CHECK(half.deviation_m == Approx(0.75).epsilon(0.02));
  CHECK(half.largest_deviation_m == Approx(1.5).epsilon(0.02));
}

TEST_CASE("A program that leads a centimetre or less from its start has no way") {
  CHECK(std::isnan(MeasureRun(Drive({}), Line(0.0099), {}, {}).deviation_m));
  CHECK_FALSE(std::isnan(MeasureRun(Drive({}), Line(0.0101), {}, {}).deviation_m));
}

TEST_CASE("A robot that stays where it is did not move and has no numbers") {
  const RunMeasures stuck =
      MeasureRun(Drive({.left_grip = 0.01, .right_grip = 0.01}), Line(1.5), {}, {});
  CHECK_FALSE(stuck.did_move);
  CHECK(std::isnan(stuck.deviation_m));
  CHECK(std::isnan(stuck.slip_left));
  const CellMeasures cell = MeasureCell(std::vector{stuck, stuck}, std::vector<Trajectory>(2));
  CHECK(cell.runs == 2);
  CHECK(cell.moved == 0);
  CHECK_FALSE(cell.DidMove());
  CHECK(std::isnan(cell.deviation_m));
}

TEST_CASE("A program that only turns is judged by its turn") {
  Trajectory turn;
  for (int i = 0; i <= 90; ++i) {
    turn.poses.push_back({.t_s = 0.1 * i, .yaw_rad = 0.1 * i});
  }
  RunLog run = Drive({.left_mps = -0.05, .right_mps = 0.05});
  for (trajectory::StampedPose& pose : run.camera.poses) pose.x_m += 1e-4 * std::sin(pose.t_s);
  CHECK_NOTHROW(MeasureRun(run, std::nullopt, {}, {}));
  RunLog still = run;
  for (trajectory::StampedPose& pose : still.camera.poses) pose.yaw_rad = 0.3;
  CHECK_FALSE(MeasureRun(still, turn, {}, {}).did_move);
}

/// Two turns on the spot, the second of which takes the first one back, of `degrees` each.
Trajectory ThereAndBack(double degrees) {
  Trajectory program;
  for (int i = 0; i <= 200; ++i) {
    const double share = 1.0 - std::abs(i - 100) / 100.0;
    const double turn_rad = geometry::RadFromDeg(share * degrees);
    program.poses.push_back(
        {.t_s = 0.05 * i, .x_m = 0.1, .y_m = 0.2, .yaw_rad = geometry::WrapToPi(0.3 + turn_rad)});
  }
  return program;
}

/// The camera of a robot that stands and then turns so, and its wheels.
RunLog TurnOnTheSpot(double degrees, double tag_ahead_m = 0.0) {
  const OdometryOptions wheels;
  RunLog run{.name = "turn"};
  Trajectory way = ThereAndBack(degrees);
  const trajectory::StampedPose stands = way.poses.front();
  way.poses.insert(way.poses.begin(), 40, stands);
  for (std::size_t i = 0; i < 40; ++i) way.poses[i].t_s = 0.05 * (static_cast<double>(i) - 40.0);
  for (const trajectory::StampedPose& pose : way.poses) {
    const double share = std::max(0.0, 1.0 - std::abs(pose.t_s - 5.0) / 5.0);
    const double turn_rad = geometry::RadFromDeg(share * degrees);
    const auto right = static_cast<std::int64_t>(
        std::lround(0.5 * turn_rad * wheels.drive.track_m / MetresPerCount(wheels)));
    run.encoders.push_back({pose.t_s, {-right, right}});
    const geometry::Pose2 tag = pose.Planar() * geometry::Pose2{tag_ahead_m, 0.0, 0.0};
    run.camera.poses.push_back(
        {.t_s = pose.t_s, .x_m = tag.x_m, .y_m = tag.y_m, .yaw_rad = tag.yaw_rad});
  }
  return run;
}

TEST_CASE("A program that only turns has no way, and what its runs tell without one") {
  const double tag_ahead_m = GENERATE(0.0, 0.05);
  INFO(tag_ahead_m);
  Trajectory program = ThereAndBack(360.0);
  for (trajectory::StampedPose& pose : program.poses) {  // the tag begins on it
    const Eigen::Vector2d ahead_m = tag_ahead_m * program.poses.front().Planar().Forward();
    pose.x_m += ahead_m.x();
    pose.y_m += ahead_m.y();
  }
  const RunLog log = TurnOnTheSpot(360.0, tag_ahead_m);
  const RunMeasures run = MeasureRun(log, program, {}, {.tag_ahead_m = tag_ahead_m});
  CHECK(run.did_move);
  CHECK(run.end_error_m < 1e-9);
  CHECK(run.odometry_gap_m < 0.002);
  CHECK(std::abs(run.yaw_drift_rad) < 0.02);
  CHECK(run.slip_left == Approx(0.0).margin(0.01));
  CHECK(std::isnan(run.deviation_m));
  CHECK(std::isnan(run.largest_deviation_m));
  CHECK(std::isnan(run.drift_per_m));
  RunLog pushed = log;
  for (trajectory::StampedPose& pose : pushed.camera.poses) pose.x_m += 0.02 * pose.t_s / 10.0;
  CHECK(MeasureRun(pushed, program, {}, {.tag_ahead_m = tag_ahead_m}).end_error_m == Approx(0.02));
  const CellMeasures cell = MeasureCell(std::vector{run, run}, std::vector{log.camera, log.camera});
  CHECK(cell.moved == 2);
  CHECK(std::isnan(cell.deviation_m));
  CHECK(std::isnan(cell.spread_m));
  CHECK(cell.odometry_gap_m == Approx(run.odometry_gap_m));
}

TEST_CASE("Odometry begins as the robot stood also where it first turned under its tag and held") {
  const OdometryOptions wheels = [] {
    OdometryOptions fine;
    fine.counts_per_wheel_turn = 1e6;
    return fine;
  }();
  RunLog run{.name = "spin"};
  geometry::Pose2 at{0.1, 0.2, 0.3};
  double left_m = 0.0, right_m = 0.0;
  const auto add = [&](int steps, double length_m, double turn_rad) {
    for (int i = 0; i < steps; ++i) {
      left_m += (length_m - 0.5 * turn_rad * wheels.drive.track_m) / steps;
      right_m += (length_m + 0.5 * turn_rad * wheels.drive.track_m) / steps;
      at = at * control::ArcMotion(length_m / steps, turn_rad / steps);
      const double t_s = 0.05 * static_cast<double>(run.encoders.size());
      const double metres = MetresPerCount(wheels);
      run.encoders.push_back(
          {t_s, {std::llround(left_m / metres), std::llround(right_m / metres)}});
      run.camera.poses.push_back({.t_s = t_s, .x_m = at.x_m, .y_m = at.y_m, .yaw_rad = at.yaw_rad});
    }
  };
  add(10, 0.0, 0.0);
  add(20, 0.0, 0.5 * geometry::kPi);
  add(40, 0.0, 0.0);
  add(40, 0.5, 0.0);
  const RunMeasures measured = MeasureRun(run, std::nullopt, wheels, {});
  CHECK(measured.drift_per_m < 1e-3);
  CHECK(std::abs(measured.yaw_drift_rad) < 1e-3);
  CHECK(measured.odometry_gap_m < 1e-3);
}

TEST_CASE("A robot that is stuck in turns that take each other back did not move") {
  const auto did_move = [](double degrees, double noise_rad) {
    RunLog run = TurnOnTheSpot(degrees);
    double sign = 1.0;
    for (trajectory::StampedPose& pose : run.camera.poses) {
      pose.yaw_rad = geometry::WrapToPi(pose.yaw_rad + noise_rad * (sign = -sign));
    }
    return MeasureRun(run, ThereAndBack(360.0), {}, {}).did_move;
  };
  CHECK(did_move(360.0, 0.0));
  CHECK(did_move(37.0, 0.0));
  CHECK_FALSE(did_move(35.0, 0.0));
  CHECK_FALSE(did_move(0.0, 0.0));
  CHECK_FALSE(did_move(0.0, 0.02));  // the noise of 200 poses is more than a turn when added up
}

TEST_CASE("The spread is the root of both variances at equal u") {
  // Two lines 0.1 apart: at every u the standard deviation across is 0.1 / sqrt 2.
  CHECK(Spread_m(std::vector{Line(1.0), Line(1.0, 0.1)}) == Approx(0.1 / std::sqrt(2.0)));
  // Lengths 1 and 1.2: at u they are 0.2 u apart, 0.1 on average.
  CHECK(Spread_m(std::vector{Line(1.0), Line(1.2)}) == Approx(0.1 / std::sqrt(2.0)).epsilon(0.001));
  CHECK(Spread_m(std::vector{Line(1.0), Line(1.0)}) == Approx(0.0).margin(1e-12));
  CHECK(std::isnan(Spread_m(std::vector{Line(1.0)})));
}

TEST_CASE("A cell is the mean of its runs that moved") {
  const RunLog a = Drive({}), b = Drive({.right_mps = 0.31});
  const RunLog stuck = Drive({.left_grip = 0.0, .right_grip = 0.0});
  const std::optional<Trajectory> program = Line(1.5, 0.02);
  const std::vector<RunMeasures> runs{MeasureRun(a, program, {}, {}),
                                      MeasureRun(stuck, program, {}, {}),
                                      MeasureRun(b, program, {}, {})};
  const CellMeasures cell = MeasureCell(runs, std::vector{a.camera, stuck.camera, b.camera});
  CHECK(cell.runs == 3);
  CHECK(cell.moved == 2);
  CHECK(cell.DidMove());
  CHECK(cell.deviation_m == Approx(0.5 * (runs[0].deviation_m + runs[2].deviation_m)));
  CHECK(cell.spread_m == Approx(Spread_m(std::vector{a.camera, b.camera})));
  CHECK(cell.deviation_interval_m.low < cell.deviation_m);
}

/// The same run, before whose log a hand pushed the robot and turned it: the wheels rolled, and the
/// camera logged nothing.
RunLog PushedBefore(RunLog run, std::int64_t left, std::int64_t right) {
  std::vector<EncoderReading> all;
  for (int i = 20; i > 0; --i) {
    all.push_back({run.encoders.front().t_s - 0.05 * i, {-left * i / 20, -right * i / 20}});
  }
  all.insert(all.end(), run.encoders.begin(), run.encoders.end());
  // Both go on after the log.
  const EncoderReading last = all.back();
  all.push_back({last.t_s + 1.0, {last.counts.left + left, last.counts.right + right}});
  run.encoders = all;
  return run;
}

TEST_CASE("What the wheels did before and after the log is none of the run's odometry") {
  const auto [left, right] = GENERATE(table<int, int>({{-400, 400}, {600, 600}, {0, 300}}));
  INFO(left << " and " << right << " counts");
  const RunLog run = Drive({.right_mps = 0.33, .right_grip = 0.9});
  const RunMeasures alone = MeasureRun(run, std::nullopt, {}, {});
  const RunMeasures pushed = MeasureRun(PushedBefore(run, left, right), std::nullopt, {}, {});
  CHECK(pushed.odometry_gap_m == Approx(alone.odometry_gap_m).margin(1e-9));
  CHECK(pushed.drift_per_m == Approx(alone.drift_per_m).margin(1e-9));
  CHECK(pushed.yaw_drift_rad == Approx(alone.yaw_drift_rad).margin(1e-9));

  const std::vector<RunLog> both{Drive({.left_mps = -0.05, .right_mps = 0.15}),
                                 Drive({.left_mps = 0.15, .right_mps = -0.05})};
  const std::optional<Umbmark> told = UmbmarkOf(both, {});
  const std::optional<Umbmark> told_pushed = UmbmarkOf(
      std::vector{PushedBefore(both[0], left, right), PushedBefore(both[1], left, right)}, {});
  REQUIRE((told && told_pushed));
  CHECK((told_pushed->ccw_m - told->ccw_m).norm() < 1e-9);
  CHECK((told_pushed->cw_m - told->cw_m).norm() < 1e-9);
}

TEST_CASE("Readings are cut where the log begins and ends, with the counts of those moments") {
  const std::vector<EncoderReading> readings{
      {1.0, {0, 100}}, {2.0, {10, 80}}, {3.0, {20, 60}}, {4.0, {40, 60}}};
  const auto during = [&](double from_s, double to_s) {
    Trajectory log;
    log.poses = {{.t_s = from_s}, {.t_s = to_s}};
    std::vector<std::array<double, 3>> found;
    for (const EncoderReading& reading : ReadingsDuring(log, readings)) {
      found.push_back({reading.t_s, static_cast<double>(reading.counts.left),
                       static_cast<double>(reading.counts.right)});
    }
    return found;
  };
  using Rows = std::vector<std::array<double, 3>>;
  CHECK(during(1.5, 3.5) == Rows{{1.5, 5, 90}, {2, 10, 80}, {3, 20, 60}, {3.5, 30, 60}});
  CHECK(during(2.0, 3.0) == Rows{{2, 10, 80}, {3, 20, 60}});
  CHECK(during(0.0, 9.0) == Rows{{1, 0, 100}, {2, 10, 80}, {3, 20, 60}, {4, 40, 60}});
  CHECK(during(3.25, 3.5) == Rows{{3.25, 25, 60}, {3.5, 30, 60}});
  CHECK(during(4.0, 5.0).size() < 2);
  CHECK(during(0.0, 1.0).size() < 2);
  CHECK(during(5.0, 6.0).size() < 2);
}

TEST_CASE("Encoders of another time than the camera are refused") {
  RunLog run = Drive({});
  for (EncoderReading& reading : run.encoders) reading.t_s += 100.0;
  CHECK_THROWS_WITH(MeasureRun(run, std::nullopt, {}, {}), Catch::Contains("on one clock"));
}

TEST_CASE("Odometry begins and ends on the line between the rows around its readings") {
  // Along +y with a heading that passes from 179 degrees over 180 to 179 on the other side.
  RunLog run{.name = "r"};
  for (int i = 0; i <= 40; ++i) {
    const int k = std::max(0, i - 10);
    run.camera.poses.push_back({.t_s = 1.0 * i,
                                .x_m = 0.5 - 0.1 * k,
                                .y_m = -0.25 + 0.2 * k,
                                .yaw_rad = geometry::WrapToPi(3.0 + 0.04 * k)});
  }
  for (int i = 0; i <= 3; ++i) run.encoders.push_back({13.25 + 6.25 * i, {100 * i, 120 * i}});
  const geometry::Pose2 start = OdometryStart(run), end = OdometryEnd(run);
  CHECK(start.x_m == Approx(0.5 - 0.325));
  CHECK(start.y_m == Approx(-0.25 + 0.65));
  CHECK(geometry::WrapToPi(start.yaw_rad - 3.13) == Approx(0.0).margin(1e-9));
  CHECK(end.x_m == Approx(0.5 - 2.2));
  CHECK(end.y_m == Approx(-0.25 + 4.4));
  CHECK(geometry::WrapToPi(end.yaw_rad - 3.88) == Approx(0.0).margin(1e-9));
  run.encoders.front().t_s = 13.75;  // between 3.12 and 3.16, which is -3.123
  CHECK(geometry::WrapToPi(OdometryStart(run).yaw_rad - 3.15) == Approx(0.0).margin(1e-9));
  run.encoders.front().t_s = 14.0;
  CHECK(OdometryStart(run).x_m == Approx(0.1));
  run.encoders.back().t_s = 99.0;  // the camera's last row
  CHECK(OdometryEnd(run).y_m == Approx(-0.25 + 6.0));
  run.encoders.clear();
  CHECK(OdometryStart(run).x_m == Approx(0.5));
  CHECK(OdometryEnd(run).x_m == Approx(-2.5));
}

TEST_CASE("A run whose clocks share one moment is told with its name and that number") {
  RunLog run = Drive({});
  run.name = "left_3";
  const double shift_s = run.camera.poses.back().t_s - run.encoders.front().t_s;
  for (EncoderReading& reading : run.encoders) reading.t_s += shift_s;
  CHECK_THROWS_WITH(MeasureRun(run, std::nullopt, {}, {}),
                    "left_3: the poses with a yaw and the encoder readings share 1 moment(s): they "
                    "must be of one run and on one clock");
}

TEST_CASE("A turn of the odometry beyond the camera's has its sign, also across half a turn") {
  for (const double side : {1.0, -1.0}) {
    RunLog run{.name = "r"};
    for (int i = 0; i <= 40; ++i) {
      const double turned_rad = side * 0.09 * std::max(0, i - 10);  // 2.7 in all
      run.encoders.push_back({0.1 * i,
                              {-std::llround(side * 21 * std::max(0, i - 10)),
                               std::llround(side * 21 * std::max(0, i - 10))}});
      run.camera.poses.push_back(
          {.t_s = 0.1 * i, .yaw_rad = geometry::WrapToPi(side * 2.0 + turned_rad)});
    }
    const double rolled_rad = side * 2.0 * 630.0 * YawPerCount_rad({});
    CHECK(MeasureRun(run, std::nullopt, {}, {}).yaw_drift_rad ==
          Approx(rolled_rad - side * 2.7).margin(1e-9));
  }
}

}  // namespace
}  // namespace rift::odometry
