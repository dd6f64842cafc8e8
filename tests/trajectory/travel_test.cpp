// How a yaw agrees with the way, by closed forms, and whole lines of doubts with their numbers.
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "rift/trajectory/log.hpp"
#include "trajectory/plausibility.hpp"

namespace rift::trajectory {
namespace {

using Lines = std::vector<std::string>;

/// A row each 0.05 s along x, so far apart.
Trajectory Along(int rows, double step_m, double yaw_rad = 0.0) {
  Trajectory log;
  for (int i = 0; i < rows; ++i) {
    log.poses.push_back({.t_s = 0.05 * i, .x_m = step_m * i, .yaw_rad = yaw_rad});
  }
  return log;
}

TEST_CASE("The agreement of a yaw is the cosine of twice its error, of three pieces or more") {
  CHECK(std::isnan(TravelAgreement({})));
  CHECK(std::isnan(TravelAgreement(Along(3, 0.1))));
  CHECK(TravelAgreement(Along(4, 0.1)) == Approx(1.0));
  for (const double off_rad : {0.0, 0.3, -0.3, 0.8, std::numbers::pi / 2.0, std::numbers::pi}) {
    INFO(off_rad);
    CHECK(TravelAgreement(Along(10, 0.1, off_rad)) ==
          Approx(std::cos(2.0 * off_rad)).margin(1e-12));
  }
  CHECK(std::isnan(TravelAgreement(Along(10, 0.1, StampedPose::kNotLogged))));
}

TEST_CASE("The yaw of a piece of the way is the one in its middle") {
  // A circle in steps of 0.06 rad, of which two make a piece: more than a thirtieth of the square's
  // diagonal, 0.094 of the radius. Between them the yaw is that of the chord.
  Trajectory log;
  for (int i = 0; i < 105; ++i) {
    const double turn_rad = 0.06 * i;
    log.poses.push_back({.t_s = 0.05 * i,
                         .x_m = 2.0 * std::sin(turn_rad),
                         .y_m = -2.0 * std::cos(turn_rad),
                         .yaw_rad = turn_rad});
  }
  CHECK(TravelAgreement(log) == Approx(1.0).epsilon(1e-9));
}

TEST_CASE("Times, speeds and extents that no robot has are told with their numbers") {
  Trajectory log = Along(40, 0.625);
  CHECK(Doubts(log, false, {.length = "L", .time = "T"}) ==
        Lines{"it moves at 12.5 m/s, and no robot here drives faster than 10: are its positions in "
              "mm or cm? name the unit, as in L"});
  CHECK(Doubts(log)[0].ends_with("name the unit, as in --units mm"));
  for (auto& pose : log.poses) pose.t_s *= 60.0;
  CHECK(Doubts(log, false, {.length = "L", .time = "T"}) ==
        Lines{"its poses are 3 s apart: are its times in ms, us or ns? name the unit, as in T"});
  CHECK(Doubts(log)[0].ends_with("name the unit, as in --units ms"));
  for (auto& pose : log.poses) pose.t_s *= 1e-5;
  CHECK(Doubts(log) ==
        Lines{"its poses are 3e-05 s apart: are its times in another unit than they are read in?"});
  CHECK(Doubts(Along(21, 0.0001)) ==
        Lines{"the whole path lies within 0.002 m: metres read as a smaller unit, or another "
              "column?"});
}

TEST_CASE("A robot that lies on its side is told with its larger tilt") {
  Trajectory log = Along(40, 0.01);
  for (auto& pose : log.poses) {
    pose.roll_rad = 0.3;
    pose.pitch_rad = -1.3;
  }
  CHECK(Doubts(log) ==
        Lines{"the robot lies on its side, 1.3 rad of roll or pitch: degrees read as radians, or a "
              "quaternion in another order (w first)?"});
  for (auto& pose : log.poses) pose.pitch_rad = 0.3;
  CHECK(Doubts(log).empty());
}

TEST_CASE("A robot that jitters by less than five centimetres has no direction of travel") {
  const auto notes = [](double jitter_m) {
    std::string text = "t,x,y,z,roll,pitch,yaw\n";
    for (int i = 0; i < 60; ++i) {
      text += std::to_string(0.05 * i) + ",0," + std::to_string(i % 2 == 0 ? 0.0 : jitter_m) +
              ",0.8,0,0,2\n";
    }
    return ReadLog(text, "a.csv", Format::kTracker).notes;
  };
  CHECK(notes(0.049).empty());
  CHECK(notes(0.051) ==
        Lines{"the path turns and no angle exceeds 2.00 degrees, which looks like radians: is it a "
              "webots log?"});
}

TEST_CASE("A robot stands within a centimetre of its first row, unless another radius is given") {
  // At 0, 9.9 mm and 10.1 mm: of two rows the mean, of one itself.
  Trajectory log;
  for (const double y_m : {0.0, 0.0099, 0.0101, 0.0}) {
    log.poses.push_back({.t_s = 0.1 * static_cast<double>(log.poses.size()),
                         .x_m = 1.0,
                         .y_m = 2.0 - y_m,
                         .yaw_rad = 0.5});
  }
  CHECK(StandingPose(log).y_m == Approx(2.0 - 0.0099 / 2.0));
  CHECK(StandingPose(log, 0.0098).y_m == 2.0);
  CHECK(StandingPose(log, 0.0102).y_m == Approx(2.0 - 0.0099 / 2.0));  // the median of four
  CHECK(StandingPose(log).x_m == 1.0);
  CHECK(StandingPose(log).yaw_rad == Approx(0.5));
  log.poses[3].yaw_rad = StampedPose::kNotLogged;
  CHECK_THROWS_WITH(StandingPose(log),
                    "the pose of the standing robot needs the yaw, which is not known");
  CHECK_THROWS_WITH(OffsetAlongHeading(log, -0.01),
                    "a tag offset shifts the path along the yaw, and the yaw is not known");
}

TEST_CASE("A point behind the tag is taken against its heading") {
  Trajectory log = Along(3, 0.1, 0.25);
  const Trajectory behind = OffsetAlongHeading(log, -0.04);
  for (size_t i = 0; i < 3; ++i) {
    CHECK(behind.poses[i].x_m == Approx(log.poses[i].x_m - 0.04 * std::cos(0.25)));
    CHECK(behind.poses[i].y_m == Approx(-0.04 * std::sin(0.25)));
    CHECK(behind.poses[i].yaw_rad == 0.25);
    CHECK(behind.poses[i].t_s == log.poses[i].t_s);
  }
}

}  // namespace
}  // namespace rift::trajectory
