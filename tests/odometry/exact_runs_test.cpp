// Runs made by hand, of which every number is known.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "rift/geometry/pose2.hpp"
#include "rift/odometry/calibration.hpp"
#include "rift/odometry/program_runs.hpp"

namespace rift::odometry {
namespace {

using geometry::Pose2;
using trajectory::Trajectory;

/// A millimetre a count, wheels 0.1 m apart.
OdometryOptions Millimetres() {
  OdometryOptions options;
  options.counts_per_wheel_turn = 2.0 * geometry::kPi * 16.0;
  options.drive.wheel_radius_m = 0.016;
  options.drive.track_m = 0.1;
  return options;
}

/// Readings a tenth of a second apart, and what the camera saw then; counts in mm.
RunLog Run(const std::vector<std::pair<int, int>>& counts, const std::vector<Pose2>& seen) {
  RunLog run{.name = "r"};
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const double t_s = 0.1 * static_cast<double>(i);
    run.encoders.push_back({t_s, {counts[i].first, counts[i].second}});
    run.camera.poses.push_back(
        {.t_s = t_s, .x_m = seen[i].x_m, .y_m = seen[i].y_m, .yaw_rad = seen[i].yaw_rad});
  }
  return run;
}

TEST_CASE("A count is the circumference over the counts of a turn, and turns by the track") {
  const OdometryOptions options = Millimetres();
  CHECK(MetresPerCount(options) == Approx(1e-3));
  CHECK(YawPerCount_rad(options) == Approx(1e-2));
  OdometryOptions unequal = options;
  unequal.right_over_left = 1.5;
  CHECK(LeftMetresPerCount(unequal) == Approx(0.8e-3));
  CHECK(RightMetresPerCount(unequal) == Approx(1.2e-3));
  for (const double bad : {0.0, -1.0, std::nan("")}) {
    unequal.right_over_left = bad;
    CHECK_THROWS_WITH(Odometry(unequal), Catch::Contains("right_over_left is"));
    OdometryOptions counts = options;
    counts.counts_per_wheel_turn = bad;
    CHECK_THROWS_WITH(Odometry(counts), Catch::Contains("counts_per_wheel_turn is"));
  }
}

TEST_CASE("A quarter of an arc ends a radius ahead and a radius aside, to either side") {
  for (const int side : {1, -1}) {  // left, right
    // Half a metre of radius: the inner wheel rolls 0.45 pi / 2, the outer 0.55 pi / 2.
    Odometry odometry(Millimetres(), {1.0, 2.0, geometry::kPi / 2.0});
    odometry.Update({0, 0});
    Pose2 end;
    for (int i = 1; i <= 100; ++i) {
      const auto inner = std::llround(4.5 * geometry::kPi / 2.0 * i),
                 outer = std::llround(5.5 * geometry::kPi / 2.0 * i);
      end = odometry.Update(side > 0 ? control::EncoderCounts{inner, outer}
                                     : control::EncoderCounts{outer, inner});
    }
    CHECK(end.x_m == Approx(1.0 - 0.5 * side).margin(2e-3));
    CHECK(end.y_m == Approx(2.5).margin(2e-3));
    CHECK(geometry::WrapToPi(end.yaw_rad - geometry::kPi / 2.0) ==
          Approx(side * geometry::kPi / 2.0).margin(1e-2));
  }
}

TEST_CASE("Odometry has a pose for each reading, on its clock") {
  const std::vector<EncoderReading> readings{{5.0, {7, 7}}, {5.5, {107, 107}}, {6.5, {207, 207}}};
  const Trajectory path = OdometryPath(readings, Millimetres(), {1.0, 0.0, 0.0});
  REQUIRE(path.poses.size() == 3);
  CHECK(path.poses[0].t_s == 5.0);
  CHECK(path.poses[0].x_m == 1.0);
  CHECK(path.poses[1].x_m == Approx(1.1));
  CHECK(path.poses[2].t_s == 6.5);
  CHECK(path.poses[2].x_m == Approx(1.2));
  CHECK(path.poses[2].yaw_rad == 0.0);
}

TEST_CASE("A file of readings has these columns, in any order, and rising times") {
  CHECK(EncodersHeader() == "t_s,left,right,battery_v\n");
  CHECK(EncodersRow({0.5, {-3, 4}}) == "0.5,-3,4,\n");
  CHECK(EncodersRow({0.5, {-3, 4}, 5.25}) == "0.5,-3,4,5.25\n");
  const auto read = ReadEncoders("right,left,t_s\n4,-3,0.5\n6,-5,0.75\n", "e.csv");
  REQUIRE(read.size() == 2);
  CHECK(read[0].counts == control::EncoderCounts{-3, 4});
  CHECK(read[1].t_s == 0.75);
  CHECK(std::isnan(read[1].battery_v));
  for (const char* column : {"t_s", "left", "right"}) {
    std::string text = "t_s,left,right\n0,1,1\n1,2,2\n";
    text.replace(text.find(column), std::string(column).size(), "other");
    CHECK_THROWS_WITH(ReadEncoders(text, "e.csv"),
                      Catch::Contains(std::string("no column '") + column));
  }
  CHECK_THROWS_WITH(ReadEncoders("t_s,left,right\n0,1,1\n1,2,9.1e15\n", "e.csv"),
                    Catch::Contains("a count beyond"));
  CHECK_THROWS_WITH(ReadEncoders("t_s,left,right\n0,1,1\n1,-9.1e15,2\n", "e.csv"),
                    Catch::Contains("a count beyond"));
  CHECK_NOTHROW(ReadEncoders("t_s,left,right\n0,1,1\n1,-8.9e15,8.9e15\n", "e.csv"));
  CHECK_THROWS_WITH(ReadEncoders("t_s,left,right\n0,1,1\n1,2,\n", "e.csv"),
                    Catch::Contains("must be there"));
  CHECK_THROWS_WITH(ReadEncoders("t_s,left,right\n2,1,1\n1,2,2\n", "e.csv"),
                    Catch::Contains("t_s is 1, and the row before has 2"));
}

/// Ten centimetres ahead in steps of one; the camera sees this share of it, and these turns.
RunLog Ahead(double share, double turned_rad = 0.0, int steps = 10) {
  // It stands at first: where that is, is the median of what was seen then.
  std::vector<std::pair<int, int>> counts(30, {0, 0});
  std::vector<Pose2> seen(30, Pose2{0.0, 0.0, 0.0});
  for (int i = 0; i <= steps; ++i) {
    counts.emplace_back(10 * i, 10 * i);
    seen.push_back({share * 0.01 * i, 0.0, turned_rad * i / steps});
  }
  return Run(counts, seen);
}

TEST_CASE("Drift is the distance of both ends over the camera's way, and a turn of its own sign") {
  const RunMeasures measures = MeasureRun(Ahead(0.8), std::nullopt, Millimetres(), {});
  CHECK(measures.length_m == Approx(0.08));
  CHECK(measures.odometry_gap_m == Approx(0.02));
  CHECK(measures.drift_per_m == Approx(0.25));
  CHECK(measures.yaw_drift_rad == Approx(0.0).margin(1e-12));
  CHECK(measures.slip_left == Approx(0.2));
  CHECK(measures.slip_right == Approx(0.2));
  CHECK(MeasureRun(Ahead(1.0, 0.1), std::nullopt, Millimetres(), {}).yaw_drift_rad == Approx(-0.1));
  CHECK(MeasureRun(Ahead(1.0, -0.1), std::nullopt, Millimetres(), {}).yaw_drift_rad == Approx(0.1));
}

/// The readings from that moment on, or until then.
RunLog ReadFrom(RunLog run, double from_s) {
  std::erase_if(run.encoders, [&](const EncoderReading& one) { return one.t_s < from_s; });
  return run;
}
RunLog ReadUntil(RunLog run, double to_s) {
  std::erase_if(run.encoders, [&](const EncoderReading& one) { return one.t_s > to_s; });
  return run;
}

TEST_CASE("Odometry whose readings begin on the way begins where the camera saw the robot then") {
  // It stands for three seconds, and a tenth of a second later it is a centimetre on.
  const RunLog run = Ahead(1.0, 0.0, 100);
  for (const double from_s : {2.0, 3.15, 5.0, 8.0, 8.04}) {
    INFO(from_s);
    RunLog late = ReadFrom(run, from_s);
    const auto [left, right] = *CountsAt(run.encoders, from_s);
    late.encoders.insert(late.encoders.begin(),
                         {from_s - 1e-6, {std::llround(left), std::llround(right)}});
    const RunMeasures measures = MeasureRun(late, std::nullopt, Millimetres(), {});
    CHECK(measures.odometry_gap_m < 6e-4);  // half a count
    CHECK(measures.length_m == Approx(1.0));
  }
  RunLog short_of = Ahead(0.8, 0.0, 100);  // the wheels roll a metre, the robot goes 0.8 m
  const RunMeasures half = MeasureRun(ReadFrom(short_of, 8.0), std::nullopt, Millimetres(), {});
  CHECK(half.odometry_gap_m == Approx(0.1));
  CHECK(half.drift_per_m == Approx(0.1 / 0.4));  // of the way that both logged
  CHECK(half.length_m == Approx(0.8));
  // Readings that end early tell nothing of what came later.
  const RunMeasures first = MeasureRun(ReadUntil(short_of, 8.0), std::nullopt, Millimetres(), {});
  CHECK(first.odometry_gap_m == Approx(0.1));
  CHECK(first.drift_per_m == Approx(0.1 / 0.4));
}

TEST_CASE("One row that jumps is no robot that has left its place") {
  RunLog run = Ahead(1.0);
  run.camera.poses[10].x_m = 0.5;
  const RunLog late = ReadFrom(run, 1.0);
  CHECK(OdometryStart(late).x_m == Approx(0.0).margin(1e-12));
  run.camera.poses[11].x_m = 0.5;  // two are
  CHECK(OdometryStart(ReadFrom(run, 1.0)).x_m == Approx(0.5));
  // A robot that turned where it stood has left it too.
  RunLog turned = Ahead(1.0);
  for (std::size_t i = 8; i < turned.camera.poses.size(); ++i) {
    turned.camera.poses[i].yaw_rad = 1.0;
  }
  CHECK(OdometryStart(ReadFrom(turned, 1.0)).yaw_rad == Approx(1.0));
  CHECK(OdometryStart(turned).yaw_rad == Approx(0.0).margin(1e-12));
}

TEST_CASE("A row without a yaw is left out of odometry, and a log without any is refused") {
  RunLog run = Ahead(0.8);
  const RunMeasures all = MeasureRun(run, std::nullopt, Millimetres(), {});
  for (const std::size_t row : {0U, 5U, 33U, 40U}) {
    INFO(row);
    RunLog lacking = run;
    lacking.camera.poses[row].yaw_rad = std::nan("");
    for (const double tag_ahead_m : {0.0, 0.03}) {
      const RunMeasures some =
          MeasureRun(lacking, std::nullopt, Millimetres(), {.tag_ahead_m = tag_ahead_m});
      CHECK(some.odometry_gap_m == Approx(all.odometry_gap_m).margin(0.0021));
    }
  }
  for (trajectory::StampedPose& pose : run.camera.poses) pose.yaw_rad = std::nan("");
  CHECK_THROWS_WITH(MeasureRun(run, std::nullopt, Millimetres(), {}),
                    "r: no row has a yaw, and odometry goes from the heading of the robot: log "
                    "yaw_rad");
}

TEST_CASE("The length of a run and its drift are the same with a program and without one") {
  RunLog run = Ahead(0.8, 0.0, 100);
  for (std::size_t i = 0; i < 30; ++i) run.camera.poses[i].x_m = i % 2 == 0 ? 0.0 : 0.004;
  Trajectory program;
  for (int i = 0; i <= 10; ++i) {
    program.poses.push_back({.t_s = 1.0 * i, .x_m = 0.1 * i, .yaw_rad = 0.0});
  }
  const RunMeasures without = MeasureRun(run, std::nullopt, Millimetres(), {});
  const RunMeasures with = MeasureRun(run, program, Millimetres(), {});
  CHECK(without.length_m == Approx(0.8).epsilon(0.01));  // 0.91 with the jitter
  CHECK(with.length_m == without.length_m);
  CHECK(with.drift_per_m == without.drift_per_m);
}

TEST_CASE("Slip is taken over as many parts of the way as are asked for") {
  const RunMeasures four =
      MeasureRun(Ahead(0.8, 0.0, 40), std::nullopt, Millimetres(), {.slip_bins = 4});
  REQUIRE(four.slip.size() == 4);
  for (std::size_t i = 0; i < 4; ++i) {
    CHECK(four.slip[i].u == Approx(0.125 + 0.25 * static_cast<double>(i)));
    CHECK(four.slip[i].left == Approx(0.2));
  }
  // The second half of the way slips alone.
  RunLog run = Ahead(1.0, 0.0, 40);
  for (std::size_t i = 30 + 21; i <= 30 + 40; ++i) {
    run.camera.poses[i].x_m = 0.2 + 0.5 * (run.camera.poses[i].x_m - 0.2);
  }
  const RunMeasures late = MeasureRun(run, std::nullopt, Millimetres(), {.slip_bins = 2});
  CHECK(late.slip[0].right == Approx(0.0).margin(1e-9));
  CHECK(late.slip[1].right == Approx(0.5));
  CHECK(late.slip_right == Approx(0.25));
}

TEST_CASE("Between two readings the odometry is on the straight line between their places") {
  OdometryOptions micrometres = Millimetres();
  micrometres.counts_per_wheel_turn *= 1000.0;
  for (const int side : {1, -1}) {  // left, right
    // It stands, and then drives a quarter of a circle of 0.2 m from one reading to the next.
    RunLog run{.name = "r"};
    for (int i = 0; i < 30; ++i) {
      run.encoders.push_back({0.1 * i, {0, 0}});
      run.camera.poses.push_back({.t_s = 0.1 * i, .x_m = 0.0, .y_m = 0.0, .yaw_rad = 0.0});
    }
    const auto inner = std::llround(150'000.0 * geometry::kPi / 2.0),
               outer = std::llround(250'000.0 * geometry::kPi / 2.0);
    run.encoders.push_back({3.9, {side > 0 ? inner : outer, side > 0 ? outer : inner}});
    for (const double share : {0.125, 0.5, 0.75, 1.0}) {
      run.camera.poses.push_back({.t_s = 2.9 + share,
                                  .x_m = 0.2 * share,
                                  .y_m = side * 0.2 * share,
                                  .yaw_rad = side * share * geometry::kPi / 2.0});
    }
    CHECK(MeasureRun(run, std::nullopt, micrometres, {}).odometry_gap_m < 1e-5);
    // Seen half a centimetre off in between, and where it was at the end.
    run.camera.poses[31].y_m += 0.005;
    const RunMeasures off = MeasureRun(run, std::nullopt, micrometres, {});
    CHECK(off.odometry_gap_m == Approx(0.005).margin(1e-5));
    CHECK(off.drift_per_m < 1e-3);
  }
}

TEST_CASE("A wheel that rolled a millimetre or less has no slip") {
  OdometryOptions fine = Millimetres();
  fine.counts_per_wheel_turn *= 20.0;  // 0.05 mm a count
  for (const auto& [left, right] : {std::pair{19, 21}, {-19, -21}}) {
    const RunLog run = Run({{0, 0}, {left, right}}, {{0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}});
    const RunMeasures measures = MeasureRun(run, std::nullopt, fine, {});
    CHECK(std::isnan(measures.slip_left));
    CHECK(measures.slip_right == Approx(1.0));
  }
}

TEST_CASE("A tag ahead of the axle moves every place that the camera saw back by as much") {
  // The robot turns on the spot: its tag goes round, its axle stays.
  std::vector<std::pair<int, int>> counts;
  std::vector<Pose2> seen;
  for (int i = 0; i <= 20; ++i) {
    counts.emplace_back(-5 * i, 5 * i);
    const double yaw_rad = 0.1 * i;
    seen.push_back({0.04 * std::cos(yaw_rad), 0.04 * std::sin(yaw_rad), yaw_rad});
  }
  const RunLog run = Run(counts, seen);
  const RunMeasures with = MeasureRun(run, std::nullopt, Millimetres(), {.tag_ahead_m = 0.04});
  CHECK(with.odometry_gap_m < 1e-6);
  CHECK(with.length_m < 1e-6);
  CHECK(with.slip_left == Approx(0.0).margin(1e-6));
  const RunMeasures without = MeasureRun(run, std::nullopt, Millimetres(), {});
  CHECK(without.odometry_gap_m > 0.03);
  CHECK(without.length_m == Approx(0.08).epsilon(0.01));
}

TEST_CASE("A run did move from a tenth of its program's reach on") {
  Trajectory program;
  for (int i = 0; i <= 10; ++i)
    program.poses.push_back({.t_s = 1.0 * i, .x_m = 0.1 * i, .yaw_rad = 0});
  const auto did_move = [&](double reach_m, const RunOptions& options) {
    RunLog run = Ahead(10.0 * reach_m);
    run.encoders.clear();
    return MeasureRun(run, program, Millimetres(), options).did_move;
  };
  CHECK(did_move(0.1001, {}));
  CHECK_FALSE(did_move(0.0999, {}));
  CHECK(did_move(0.3001, {.moved_share = 0.3}));
  CHECK_FALSE(did_move(0.2999, {.moved_share = 0.3}));
}

RunMeasures Measures(double value) {
  RunMeasures run;
  run.deviation_m = value;
  run.drift_per_m = 2.0 * value;
  run.odometry_gap_m = 3.0 * value;
  run.slip_left = 4.0 * value;
  run.slip_right = 5.0 * value;
  run.slip = {{0.25, 6.0 * value, 7.0 * value}, {0.75, 8.0 * value, 9.0 * value}};
  return run;
}

TEST_CASE("A cell is the mean of every number over the runs that moved and have it") {
  std::vector<RunMeasures> runs{Measures(0.01), Measures(9.0), Measures(0.03)};
  runs[1].did_move = false;
  const std::vector<Trajectory> paths(3, Ahead(1.0).camera);
  const CellMeasures cell = MeasureCell(runs, paths);
  CHECK(cell.deviation_m == Approx(0.02));
  CHECK(cell.drift_per_m == Approx(0.04));
  CHECK(cell.odometry_gap_m == Approx(0.06));
  CHECK(cell.slip_left == Approx(0.08));
  CHECK(cell.slip_right == Approx(0.10));
  REQUIRE(cell.slip.size() == 2);
  CHECK(cell.slip[0].u == 0.25);
  CHECK(cell.slip[0].left == Approx(0.12));
  CHECK(cell.slip[0].right == Approx(0.14));
  CHECK(cell.slip[1].u == 0.75);
  CHECK(cell.slip[1].left == Approx(0.16));
  CHECK(cell.slip[1].right == Approx(0.18));
  // Two values 0.02 apart: Student's 97.5 % quantile of one degree, times 0.01.
  CHECK(cell.deviation_interval_m.low == Approx(0.02 - 12.7062047362 * 0.01));
  CHECK(cell.deviation_interval_m.high == Approx(0.02 + 12.7062047362 * 0.01));
  runs[0].slip_left = std::nan("");
  CHECK(MeasureCell(runs, paths).slip_left == Approx(0.12));
  CHECK(CellMeasures{.runs = 4, .moved = 2}.DidMove() == false);
  CHECK(CellMeasures{.runs = 3, .moved = 2}.DidMove());
}

TEST_CASE("Runs of one program are a cell from two on, and others are none") {
  const ProgramRun one{Ahead(1.0), std::nullopt, Millimetres()};
  const std::vector<ProgramRun> two{one, one};
  const OdometryResult same = MeasureRuns(two, true, {});
  REQUIRE(same.runs.size() == 2);
  CHECK(same.runs[0].name == "r");
  REQUIRE(same.cell);
  CHECK(same.cell->runs == 2);
  CHECK_FALSE(same.umbmark);
  CHECK_FALSE(MeasureRuns(two, false, {}).cell);
  CHECK_FALSE(MeasureRuns(std::vector{one}, true, {}).cell);
}

TEST_CASE("Each run is measured with its own wheels and tag, in whatever order") {
  const ProgramRun own{Ahead(1.0), std::nullopt, Millimetres()};
  ProgramRun larger = own, ahead = own, wide = own;
  larger.wheels.drive.wheel_radius_m *= 1.1;  // as if it had rolled a tenth further
  ahead.tag_ahead_m = 0.04;
  wide.wheels.drive.track_m *= 2.0;
  const auto drift = [](const std::vector<ProgramRun>& runs, size_t of) {
    return MeasureRuns(runs, false, {}).runs[of].measures.drift_per_m;
  };
  const double small = drift({own}, 0), large = drift({larger}, 0);
  CHECK(large > small + 0.05);
  CHECK(drift({own, larger}, 0) == small);
  CHECK(drift({own, larger}, 1) == large);
  CHECK(drift({larger, own}, 0) == large);
  CHECK(drift({larger, own}, 1) == small);
  CHECK(AreOfOneRobot(std::vector{own, own}));
  CHECK_FALSE(AreOfOneRobot(std::vector{own, larger}));
  CHECK_FALSE(AreOfOneRobot(std::vector{own, ahead}));
  CHECK_FALSE(AreOfOneRobot(std::vector{own, wide}));
  ProgramRun right = own;  // the left wheel is the same: 2 / (1 + 3) of twice the mean
  right.wheels.drive.wheel_radius_m *= 2.0;
  right.wheels.right_over_left = 3.0;
  CHECK_FALSE(AreOfOneRobot(std::vector{own, right}));
}

/// A turn on the spot by this angle in 40 steps, seen to end at (x, y) in the world's frame; the
/// robot sets out at (0.5, 0.5) with a heading of 90 degrees.
RunLog Turn(double turned_rad, double x_m, double y_m) {
  std::vector<std::pair<int, int>> counts(60, {0, 0});
  std::vector<Pose2> seen(60, Pose2{0.5, 0.5, geometry::kPi / 2.0});
  for (int i = 0; i <= 40; ++i) {
    const auto half = static_cast<int>(std::lround(50.0 * turned_rad * i / 40.0));
    counts.emplace_back(-half, half);
    seen.push_back({0.5, 0.5, geometry::WrapToPi(geometry::kPi / 2.0 + turned_rad * i / 40.0)});
  }
  seen.back().x_m += x_m;
  seen.back().y_m += y_m;
  return Run(counts, seen);
}

TEST_CASE("UMBmark is the odometry's end seen from the camera's, in the frame of the start") {
  // The odometry stays where it is: seen 0.03 m along the world's x, which is to the right.
  const std::vector<RunLog> runs{Turn(6.0, 0.03, 0.0), Turn(6.0, 0.05, 0.02), Turn(-6.0, 0.0, 0.1),
                                 Turn(3.0, 9.0, 9.0), Turn(-3.0, 9.0, 9.0)};
  const std::optional<Umbmark> found = UmbmarkOf(runs, Millimetres());
  REQUIRE(found);
  CHECK(found->ccw_runs == 2);  // the last two turn by less than half a turn
  CHECK(found->cw_runs == 1);
  CHECK(found->ccw_m.x() == Approx(-0.01).margin(1e-6));
  CHECK(found->ccw_m.y() == Approx(0.04).margin(1e-6));
  CHECK(found->cw_m.x() == Approx(-0.1).margin(1e-6));
  CHECK(found->cw_m.y() == Approx(0.0).margin(1e-6));
  CHECK(found->largest_m == Approx(0.1).margin(1e-6));
  CHECK_FALSE(UmbmarkOf(std::vector{runs[0], runs[1]}, Millimetres()));
  CHECK_FALSE(UmbmarkOf(std::vector{runs[2]}, Millimetres()));
  const std::vector<RunLog> far{Turn(6.0, 0.3, 0.0), Turn(-6.0, 0.0, 0.1)};
  CHECK(UmbmarkOf(far, Millimetres())->largest_m == Approx(0.3).margin(1e-6));
}

TEST_CASE("A UMBmark is of the time that camera and wheels share, and of rows with a yaw") {
  // Round by an arc of a decimetre in radius, which the wheels tell as it is.
  const auto round = [](int side) {
    RunLog run{.name = "r"};
    for (int i = 0; i <= 400; ++i) {
      const int steps = std::clamp(i - 50, 0, 300);
      const double yaw_rad = side * 0.02 * steps, t_s = 0.1 * i;
      const int inner = steps, outer = 3 * steps;  // mm, 0.1 m apart: 2 mm ahead and 0.02 rad
      run.encoders.push_back({t_s, {side > 0 ? inner : outer, side > 0 ? outer : inner}});
      run.camera.poses.push_back({.t_s = t_s,
                                  .x_m = 0.1 * std::sin(0.02 * steps),
                                  .y_m = side * 0.1 * (1.0 - std::cos(0.02 * steps)),
                                  .yaw_rad = geometry::WrapToPi(yaw_rad)});
    }
    return run;
  };
  const std::vector<RunLog> whole{round(1), round(-1)};
  CHECK(UmbmarkOf(whole, Millimetres())->largest_m < 1e-4);
  std::vector<RunLog> part = whole;
  for (RunLog& run : part) run = ReadUntil(ReadFrom(std::move(run), 10.03), 30.07);
  CHECK(UmbmarkOf(part, Millimetres())->largest_m < 2e-3);  // counts are rounded at both ends
  part = whole;
  for (RunLog& run : part) run.camera.poses.back().yaw_rad = std::nan("");
  CHECK(UmbmarkOf(part, Millimetres())->largest_m < 1e-4);
}

TEST_CASE("A run that did not move is none of a UMBmark, whatever its wheels turned") {
  std::vector<ProgramRun> runs;
  for (const double turned_rad : {6.0, -6.0, 6.0}) {
    const RunLog log = Turn(turned_rad, 0.0, 0.0);
    runs.push_back({log, log.camera, Millimetres()});
  }
  CHECK(MeasureRuns(runs, false, {}).umbmark.value().ccw_runs == 2);
  for (trajectory::StampedPose& pose : runs[2].log.camera.poses) pose.yaw_rad = 0.1;
  CHECK(MeasureRuns(runs, false, {}).umbmark.value().ccw_runs == 1);
}

TEST_CASE("A tag ahead of the axle is found with its distance, and left out of a UMBmark") {
  constexpr double kAhead_m = 0.03;
  const OdometryOptions wheels = Millimetres();
  std::vector<RunLog> runs;
  for (const int side : {1, -1}) {
    std::vector<std::pair<int, int>> counts{{0, 0}};
    std::vector<Pose2> seen;
    Odometry odometry(wheels, {0.2, 0.1, 0.4});
    odometry.Update({0, 0});
    for (int i = 0; i <= 400; ++i) {
      const int left = i < 10 ? 0 : counts.back().first + (side > 0 ? 8 : 16);
      const int right = i < 10 ? 0 : counts.back().second + (side > 0 ? 16 : 8);
      if (i > 0) counts.emplace_back(left, right);
      const Pose2 at =
          odometry.Update({counts.back().first, counts.back().second}) * Pose2{kAhead_m, 0.0, 0.0};
      // A millimetre to either side in turns: without any noise nothing has a scale.
      seen.push_back({at.x_m + (i % 2 == 0 ? 0.001 : -0.001), at.y_m, at.yaw_rad});
    }
    runs.push_back(Run(counts, seen));
  }
  const OdometryCalibration found = CalibrateOdometry(runs, wheels);
  CHECK(found.tag_ahead_m.value == Approx(kAhead_m).margin(2e-3));
  CHECK(found.tag_ahead_m.interval.low < kAhead_m);
  CHECK(found.tag_ahead_m.interval.high > kAhead_m);
  CHECK(found.tag_ahead_m.is_told);
  CHECK(found.runs == 2);
  CHECK(found.windows == 2 * 14);  // 40 s in pieces of 3 s
  CHECK(found.track_m.value == Approx(0.1).epsilon(0.01));
  CHECK(found.right_over_left.value == Approx(1.0).epsilon(0.01));
  CHECK(found.wheel_radius_m.value == Approx(0.016).epsilon(0.01));
  CHECK(UmbmarkOf(runs, wheels, kAhead_m)->largest_m < 0.003);
}

TEST_CASE("A calibration goes into the options member by member, the track only when it is told") {
  OdometryCalibration found{.wheel_radius_m = {0.017, {}, true},
                            .right_over_left = {1.01, {}, true},
                            .track_m = {0.09, {}, true}};
  const OdometryOptions told = found.Applied({});
  CHECK(told.drive.wheel_radius_m == 0.017);
  CHECK(told.right_over_left == 1.01);
  CHECK(told.drive.track_m == 0.09);
  CHECK(told.counts_per_wheel_turn == OdometryOptions{}.counts_per_wheel_turn);
  found.track_m.is_told = false;
  CHECK(found.Applied({}).drive.track_m == OdometryOptions{}.drive.track_m);
}

}  // namespace
}  // namespace rift::odometry
