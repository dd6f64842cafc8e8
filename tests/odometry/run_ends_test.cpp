// Where the odometry of a run begins: where the robot stood, or where it was seen by then.
#include <catch2/catch.hpp>
#include <vector>

#include "rift/odometry/program_runs.hpp"

namespace rift::odometry {
namespace {

/// Six rows a second apart at the origin, then these places along x; wheels that are read from
/// `from_s` on.
RunLog Run(const std::vector<double>& then_m, double from_s) {
  RunLog run{.name = "r"};
  for (std::size_t i = 0; i < 6 + then_m.size(); ++i) {
    run.camera.poses.push_back({.t_s = static_cast<double>(i),
                                .x_m = i < 6 ? 0.0 : then_m[i - 6],
                                .y_m = 0.0,
                                .yaw_rad = 0.0});
  }
  run.encoders = {{from_s, {0, 0}}, {100.0, {10, 10}}};
  return run;
}

double StartOf(const std::vector<double>& then_m, double from_s) {
  return OdometryStart(Run(then_m, from_s)).x_m;
}

TEST_CASE("A robot has left when it is seen away in two rows about the first reading") {
  // Between the last row at rest and the first away: two rows away tell, and the last row alone.
  CHECK(StartOf({0.5, 0.5, 0.5}, 5.75) == Approx(0.375));
  CHECK(StartOf({0.5, 0.0, 0.0}, 5.75) == 0.0);
  CHECK(StartOf({0.5}, 5.75) == Approx(0.375));
  // Behind the first row away: the next one tells.
  CHECK(StartOf({0.5, 0.5, 0.0}, 6.5) == Approx(0.5));
  CHECK(StartOf({0.5, 0.0, 0.0}, 6.5) == 0.0);
  CHECK(StartOf({0.5, 0.7}, 6.5) == Approx(0.6));
  // At that row itself as well.
  CHECK(StartOf({0.5, 0.7, 0.0}, 6.0) == Approx(0.5));
  CHECK(StartOf({0.5, 0.0, 0.5}, 6.0) == 0.0);
  // At the first row, or before it, it stands.
  CHECK(StartOf({0.5, 0.5}, 0.0) == 0.0);
  CHECK(StartOf({0.5, 0.5}, -1.0) == 0.0);
}

TEST_CASE("Away is more than a centimetre, or more than a tenth of a radian, to either side") {
  for (const double side : {1.0, -1.0}) {
    CHECK(StartOf({0.009 * side, 0.009 * side, 0.009 * side}, 7.0) == 0.0);
    CHECK(StartOf({0.011 * side, 0.011 * side, 0.011 * side}, 7.0) == Approx(0.011 * side));
    for (const double turn_rad : {0.09, 0.11}) {
      RunLog run = Run({0.0, 0.0, 0.0}, 7.0);
      for (std::size_t i = 6; i < 9; ++i) run.camera.poses[i].yaw_rad = side * turn_rad;
      const double yaw_rad = OdometryStart(run).yaw_rad;
      CHECK((yaw_rad == Approx(side * turn_rad)) == (turn_rad > 0.1));
    }
  }
}

}  // namespace
}  // namespace rift::odometry
