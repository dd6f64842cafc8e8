// What is said of two doubtful logs, whole lines with their numbers.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "rift/gap/doubts.hpp"

namespace rift::gap {
namespace {

using trajectory::Trajectory;
using Lines = std::vector<std::string>;

/// Straight from a place in a direction, so long, in rows of a hundredth of it and 0.05 s.
Trajectory Ray(double angle_rad, double length_m = 1.0, double from_m = 0.0) {
  Trajectory path;
  for (int i = 0; i <= 100; ++i) {
    const double way_m = from_m + 0.01 * i * length_m;
    path.poses.push_back({.t_s = 0.05 * i,
                          .x_m = way_m * std::cos(angle_rad),
                          .y_m = way_m * std::sin(angle_rad),
                          .z_m = 0.0});
  }
  return path;
}

TEST_CASE("A path in another unit is told with how many times as large it is") {
  CHECK(Doubts(Ray(0.1), Ray(0.1, 1040.0)) ==
        Lines{"the path of REAL is 1040 times as large as that of SIM: mm for m? name the unit, as "
              "in --real-units mm, or, where the header names one, --real-columns "
              "'t=...,x=...:mm,y=...:mm'"});
  CHECK(Doubts(Ray(0.1, 3.125), Ray(0.1)) ==
        Lines{"the path of SIM is 3.125 times as large as that of REAL: feet for m? name the unit, "
              "as in --sim-units ft, or, where the header names one, --sim-columns "
              "'t=...,x=...:ft,y=...:ft'"});
}

TEST_CASE("Wrong axes are told with the mean distance as it is and once it is mended") {
  // 0.55 rad apart, and 0.05 rad once y is turned: 2 sin(half of it) at the end, half of that on
  // average.
  CHECK(Doubts(Ray(0.3), Ray(-0.25)) ==
        Lines{"REAL lies 0.272 m from SIM on average and 0.025 m once it is mended: mirrored y: "
              "turn its sign, as in y=-COLUMN"});
}

TEST_CASE("A path that was driven from its end is told with both distances") {
  // A right angle, 1 m along x and 1 m to the left, and back again, 2 cm to its right.
  const auto corner = [](bool is_back) {
    Trajectory path;
    for (int i = 0; i <= 200; ++i) {
      const double way_m = 0.01 * (is_back ? 200 - i : i);
      const double aside_m = is_back ? 0.02 / std::sqrt(2.0) : 0.0;
      path.poses.push_back({.t_s = 0.05 * i,
                            .x_m = std::min(way_m, 1.0) + aside_m,
                            .y_m = std::max(way_m - 1.0, 0.0) - aside_m});
    }
    return path;
  };
  // Along the diagonal they are sqrt(2) (1 - way) apart, across it 0.02 m: 0.712 m on average.
  CHECK(Doubts(corner(false), corner(true)) ==
        Lines{"REAL lies 0.712 m from SIM on average and 0.02 m when it is taken from its end to "
              "its start: was one of them driven the other way?"});
  GapOptions se2;
  se2.align = Align::kSe2;
  for (const std::string& line : Doubts(corner(false), corner(true), se2)) {
    CHECK(line.find("driven the other way") == std::string::npos);
  }
}

TEST_CASE("Heights of the wrong sign are told with both distances") {
  Trajectory sim = Ray(0.0), real = Ray(0.0);
  for (auto& pose : sim.poses) pose.z_m = 0.06 * pose.x_m;
  for (auto& pose : real.poses) pose.z_m = -0.03 * pose.x_m;
  GapOptions space;
  space.dimension = Dimension::kXyz;
  CHECK(Doubts(sim, real, space).empty());  // a third of it would be left
  for (auto& pose : real.poses) pose.z_m = -0.05 * pose.x_m;
  CHECK(Doubts(sim, real, space) ==
        Lines{"REAL lies 0.055 m above or below SIM on average and 0.005 m once it is mended: "
              "mirrored z: turn its sign, as in z=-COLUMN (rift's z is up)"});
}

/// Along x in rows of a centimetre and 0.05 s.
Trajectory Piece(double from_m, double to_m) {
  Trajectory path;
  const auto rows = std::lround(100.0 * (to_m - from_m));
  for (int i = 0; i <= rows; ++i) {
    path.poses.push_back({.t_s = 0.05 * i, .x_m = from_m + 0.01 * i});
  }
  return path;
}

TEST_CASE("A log that was cut is told with what it covers and where it was in motion") {
  const std::string cut =
      " in motion: a log that was cut, so that its gap tells nothing of the robot?";
  const Trajectory whole = Piece(0.0, 1.0);
  CHECK(Doubts(whole, Piece(0.0, 0.6)) ==
        Lines{"REAL covers only u = 0.00 to 0.60 of the path of SIM and ends" + cut});
  CHECK(Doubts(Piece(0.0, 0.6), whole) ==
        Lines{"SIM covers only u = 0.00 to 0.60 of the path of REAL and ends" + cut});
  CHECK(Doubts(whole, Piece(0.25, 0.75)) ==
        Lines{"REAL covers only u = 0.25 to 0.75 of the path of SIM and begins and ends" + cut});
  CHECK(Doubts(whole, Piece(0.3, 1.0)) ==
        Lines{"REAL covers only u = 0.30 to 1.00 of the path of SIM and begins" + cut});
}

TEST_CASE("Clocks that begin a million seconds apart are told with both and what depends on them") {
  Trajectory sim = Ray(0.0), real = Ray(0.01);
  for (auto& pose : sim.poses) pose.t_s += 12.5;
  for (auto& pose : real.poses) pose.t_s += 1764322000.25;
  CHECK(Doubts(sim, real) ==
        Lines{"their clocks differ: SIM begins at 12.5 s and REAL at 1764322000 s; the gap does "
              "not depend on time, and equal_time_m counts from the first row of each"});
  real = Ray(0.01);
  for (auto& pose : real.poses) pose.t_s = 1e6 + pose.t_s;
  CHECK(Doubts(Ray(0.0), real).size() == 1);  // from a million on
  for (auto& pose : real.poses) pose.t_s -= 0.5;
  CHECK(Doubts(Ray(0.0), real).empty());
}

TEST_CASE("Times that differ by a ten-millionth of a second at most are those of the same log") {
  const auto doubts = [](double later_s) {
    Trajectory other = Ray(0.0);
    other.poses.back().t_s += later_s;
    return Doubts(Ray(0.0), other);
  };
  const Lines same{"SIM and REAL are the same log: name the robot's own"};
  CHECK(doubts(0.9e-7) == same);
  CHECK(doubts(-0.9e-7) == same);
  CHECK(doubts(1.1e-7).empty());
  CHECK(doubts(-1.1e-7).empty());
  // Heights part them in space alone.
  Trajectory higher = Ray(0.0);
  higher.poses[50].z_m = 0.001;
  CHECK(Doubts(Ray(0.0), higher) == same);
  GapOptions space;
  space.dimension = Dimension::kXyz;
  CHECK(Doubts(Ray(0.0), higher, space).empty());
}

TEST_CASE("How long each log lasts is told with its own number") {
  Trajectory real = Ray(0.01);
  for (auto& pose : real.poses) pose.t_s *= 1000.0;
  CHECK(Doubts(Ray(0.0), real) ==
        Lines{"their clocks differ: SIM lasts 5 s and REAL 5e+03 s: are the times of one in "
              "another unit?"});
}

}  // namespace
}  // namespace rift::gap
