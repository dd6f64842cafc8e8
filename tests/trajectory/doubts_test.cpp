// Logs that look read in a wrong way: what no robot on wheels does, and the mistake behind it.
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "rift/trajectory/log.hpp"

namespace rift::trajectory {
namespace {

using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;

constexpr double kPi = 3.141592653589793;

/// A curve of 2 m at 0.3 m/s, turning from -40 to 40 degrees, 20 rows a second.
Trajectory Curve() {
  Trajectory log;
  double x_m = 0.0, y_m = 0.0;
  for (int i = 0; i < 134; ++i) {
    const double yaw_rad = kPi / 180.0 * (-40.0 + 80.0 * i / 133.0);
    log.poses.push_back({.t_s = 0.05 * i,
                         .x_m = x_m,
                         .y_m = y_m,
                         .z_m = 0.0,
                         .roll_rad = 0.0,
                         .pitch_rad = 0.0,
                         .yaw_rad = yaw_rad});
    x_m += 0.015 * std::cos(yaw_rad);
    y_m += 0.015 * std::sin(yaw_rad);
  }
  return log;
}

std::vector<std::string> DoubtsOf(const std::function<void(StampedPose&)>& mistake,
                                  bool in_space = false) {
  Trajectory log = Curve();
  for (StampedPose& pose : log.poses) mistake(pose);
  return Doubts(log, in_space);
}

/// The only doubt.
std::string DoubtOf(const std::function<void(StampedPose&)>& mistake) {
  const std::vector<std::string> doubts = DoubtsOf(mistake);
  return doubts.size() == 1 ? doubts[0] : "doubts: " + std::to_string(doubts.size());
}

TEST_CASE("A sound log is not doubted, backwards and mirrored with its yaw included") {
  CHECK(Doubts(Curve()).empty());
  CHECK(DoubtsOf([](StampedPose& p) { p.yaw_rad += kPi; }).empty());
  CHECK(DoubtsOf([](StampedPose& p) {
          p.y_m = -p.y_m;
          p.yaw_rad = -p.yaw_rad;
        }).empty());
  CHECK(Doubts({}).empty());
}

TEST_CASE("A yaw against the direction of travel is doubted with the mistake that mends it") {
  const std::string head = "the yaw disagrees with the direction of travel: ";
  CHECK(DoubtOf([](StampedPose& p) { p.yaw_rad *= 180.0 / kPi; }) ==
        head + "degrees read as radians? name the unit as in yaw=COLUMN:deg");
  CHECK(DoubtOf([](StampedPose& p) { p.yaw_rad += kPi / 2.0; }) ==
        head + "a yaw of another zero, a quarter turn off?");
  CHECK(DoubtOf([](StampedPose& p) { p.yaw_rad -= kPi / 2.0; }) ==
        head + "a yaw of another zero, a quarter turn off?");
  CHECK(DoubtOf([](StampedPose& p) { p.yaw_rad = 7.0 * p.x_m; }) == head + "is it another column?");
  // Along a circle the mistakes of axes are told apart.
  const auto on_circle = [](const std::function<void(StampedPose&)>& mistake) {
    Trajectory log;
    for (int i = 0; i < 140; ++i) {
      const double turn_rad = 0.04 * i;
      log.poses.push_back({.t_s = 0.05 * i,
                           .x_m = 0.5 * std::sin(turn_rad),
                           .y_m = 0.5 - 0.5 * std::cos(turn_rad),
                           .yaw_rad = turn_rad});
      mistake(log.poses.back());
    }
    const std::vector<std::string> doubts = Doubts(log);
    return doubts.size() == 1 ? doubts[0] : "doubts: " + std::to_string(doubts.size());
  };
  CHECK(on_circle([](StampedPose&) {}) == "doubts: 0");
  CHECK(on_circle([](StampedPose& p) { std::swap(p.x_m, p.y_m); }) ==
        head + "x and y swapped, or a yaw from north, clockwise?");
  CHECK(on_circle([](StampedPose& p) { p.y_m = -p.y_m; }) ==
        head + "y mirrored, or a yaw that counts clockwise? turn one of them as in y=-COLUMN");
  CHECK(on_circle([](StampedPose& p) { p.yaw_rad *= kPi / 180.0; }) ==
        head + "radians read as degrees?");
}

TEST_CASE("A yaw is not held against fewer than ten pieces of a path, nor one that is not known") {
  CHECK(DoubtsOf([](StampedPose& p) { p.yaw_rad = StampedPose::kNotLogged; }).empty());
  Trajectory shorter = Curve();
  for (StampedPose& pose : shorter.poses) pose.yaw_rad += kPi / 2.0;
  shorter.poses.resize(9);
  CHECK(Doubts(shorter).empty());
  CHECK(DoubtsOf([](StampedPose& p) { p.yaw_rad += kPi / 2.0; }, true).empty());  // in space
}

TEST_CASE("Poses seconds apart, or a ten-thousandth of one, are times of another unit") {
  const auto apart = [](double factor) {
    return DoubtsOf([factor](StampedPose& p) { p.t_s *= factor; });
  };
  CHECK(apart(39.9).empty());  // 1.995 s
  REQUIRE(apart(40.1).size() == 1);
  CHECK_THAT(apart(40.1)[0], StartsWith("its poses are 2 s apart: are its times in ms, us or ns?"));
  CHECK_THAT(apart(1000.0)[0], StartsWith("its poses are 50 s apart"));
  REQUIRE(apart(1e-4).size() == 1);  // 5 us: its speed is not doubted as well
  CHECK_THAT(apart(1e-4)[0], Contains("are its times in another unit than they are read in?"));
}

TEST_CASE("A robot faster than ten metres a second has its positions in another unit") {
  const auto scaled = [](double factor) {
    return DoubtsOf([factor](StampedPose& p) {
      p.x_m *= factor;
      p.y_m *= factor;
    });
  };
  CHECK(scaled(33.0).empty());  // 9.9 m/s
  REQUIRE(scaled(34.0).size() == 1);
  CHECK_THAT(scaled(34.0)[0], StartsWith("it moves at 10.2 m/s, and no robot here drives faster "
                                         "than 10: are its positions in mm or cm?"));
}

TEST_CASE("A robot that stands most of the time is judged by its speed while it moves") {
  Trajectory log = Curve();
  for (StampedPose& pose : log.poses) {
    pose.x_m *= 40.0;
    pose.y_m *= 40.0;
  }
  const StampedPose last = log.poses.back();
  for (int i = 1; i <= 300; ++i) {
    log.poses.push_back(last);
    log.poses.back().t_s += 0.05 * i;
  }
  REQUIRE(Doubts(log).size() == 1);
  CHECK_THAT(Doubts(log)[0], StartsWith("it moves at 12 m/s"));
}

TEST_CASE("A path within three millimetres is metres read as a smaller unit") {
  const auto scaled = [](double extent_m) {
    const Trajectory log = Curve();
    const double whole_m = (log.poses.back().Position() - log.poses.front().Position()).norm();
    return DoubtsOf([factor = extent_m / whole_m](StampedPose& p) {
      p.x_m *= factor;
      p.y_m *= factor;
    });
  };
  CHECK(scaled(0.0031).empty());
  REQUIRE(scaled(0.0029).size() == 1);
  CHECK_THAT(scaled(0.0029)[0], StartsWith("the whole path lies within 0.0029 m"));
}

TEST_CASE("In space a height is a part of the way and of its speed") {
  Trajectory log = Curve();
  for (StampedPose& pose : log.poses) {
    pose.z_m = 11.0 * pose.t_s;
    pose.x_m *= 1e-4;
    pose.y_m *= 1e-4;
  }
  REQUIRE(Doubts(log, true).size() == 1);
  CHECK_THAT(Doubts(log, true)[0], StartsWith("it moves at 11 m/s"));
  CHECK_THAT(Doubts(log, false)[0], StartsWith("the whole path lies within"));
}

/// Every position `times` times in a row.
std::vector<std::string> DoubtsOfRepeated(size_t rows, size_t times, size_t alone = 0) {
  const Trajectory curve = Curve();
  Trajectory log;
  for (size_t i = 0; i < rows; ++i) {
    const size_t copies = i < alone ? 1 : times;
    for (size_t k = 0; k < copies; ++k) {
      log.poses.push_back(curve.poses[i]);
      log.poses.back().t_s = 0.05 * static_cast<double>(log.poses.size());
    }
  }
  return Doubts(log);
}

TEST_CASE("Rows that are each there twice are doubted from ten on, if four of five are") {
  REQUIRE(DoubtsOfRepeated(100, 2).size() == 1);
  CHECK(DoubtsOfRepeated(100, 2)[0] ==
        "100 of 100 positions are there twice in a row: are its rows doubled?");
  CHECK(DoubtsOfRepeated(100, 3).empty());
  CHECK(DoubtsOfRepeated(10, 2).size() == 1);
  CHECK(DoubtsOfRepeated(9, 2).empty());
  CHECK(DoubtsOfRepeated(100, 2, 20).size() == 1);
  CHECK(DoubtsOfRepeated(100, 2, 21).empty());
}

/// The curve with a stop after so many rows, its positions off by so much there, to and fro.
Trajectory WithStop(size_t after, int rows, double noise_m) {
  const Trajectory curve = Curve();
  Trajectory log;
  double t_s = 0.0;
  const auto add = [&](StampedPose pose) {
    pose.t_s = t_s += 0.05;
    log.poses.push_back(pose);
  };
  for (size_t i = 0; i < curve.poses.size(); ++i) {
    add(curve.poses[i]);
    for (int k = 0; i == after && k < rows; ++k) {
      StampedPose pose = curve.poses[i];
      pose.x_m += k % 2 == 0 ? noise_m : -noise_m;
      add(pose);
    }
  }
  return log;
}

TEST_CASE("A robot that stands on its way is told when noise makes 5 % of its arc length") {
  const std::vector<std::string> doubts = Doubts(WithStop(60, 199, 0.001));
  REQUIRE(doubts.size() == 1);
  CHECK(doubts[0] ==
        "it stands on its way for 10 s, and the noise of its positions there makes 17 % of its "
        "arc length, so that the gap compares other points: leave those rows out");
  CHECK(Doubts(WithStop(60, 200, 0.0002)).empty());
  CHECK(Doubts(WithStop(60, 10, 0.004)).empty());  // half a second is a turn
  // Before and after the way --trim-standstill takes it out.
  CHECK(Doubts(WithStop(0, 200, 0.001)).empty());
  CHECK(Doubts(WithStop(133, 200, 0.001)).empty());
}

TEST_CASE("A stop is told from a second on, and from 5 % of the arc length on") {
  // The noise of n rows to and fro is 2 n of it, its last step to the next place included, beside
  // 132 steps of 15 mm.
  const auto doubts = [](int rows, double share) {
    return Doubts(WithStop(60, rows, 1.98 * share / (1.0 - share) / (2.0 * rows))).size();
  };
  CHECK(doubts(100, 0.0515) == 1);
  CHECK(doubts(100, 0.0485) == 0);
  CHECK(doubts(20, 0.07) == 1);  // and a twentieth of a second to the next place: 1.05 s
  CHECK(doubts(18, 0.07) == 0);
}

/// 1.8 m along x in steps of 15 mm and 0.05 s; half way it stands for 1.2 s, its positions to and
/// fro by `noise_m`, and then is `jump_m` further.
std::vector<std::string> DoubtsOfStop(double noise_m, double jump_m) {
  Trajectory log;
  double x_m = 0.0;
  const auto add = [&](double off_m) {
    const double t_s = 0.05 * static_cast<double>(log.poses.size());
    log.poses.push_back({.t_s = t_s, .x_m = x_m + off_m, .y_m = 0.0});
  };
  for (int i = 0; i < 60; ++i, x_m += 0.015) add(0.0);
  x_m -= 0.015;
  for (int i = 0; i < 23; ++i) add(i % 2 == 0 ? -noise_m : noise_m);
  x_m += jump_m;
  for (int i = 0; i < 60; ++i, x_m += 0.015) add(0.0);
  return Doubts(log);
}

TEST_CASE("A stop is a stride below a fifth of the median speed, of noise within a centimetre") {
  // 1.2 s at a fifth of 0.3 m/s are 72 mm.
  CHECK(DoubtsOfStop(0.004, 0.070).size() == 1);
  CHECK(DoubtsOfStop(0.004, 0.074).empty());
  CHECK(DoubtsOfStop(0.0095, 0.015).size() == 1);
  CHECK(DoubtsOfStop(0.0105, 0.015).empty());
}

TEST_CASE("A robot that is slow all the way does not stand on it") {
  Trajectory slow;
  for (int i = 0; i < 4000; ++i) {
    slow.poses.push_back(
        {.t_s = 0.05 * i, .x_m = 0.00025 * i + (i % 2 == 0 ? 0.001 : -0.001), .y_m = 0.0});
  }
  CHECK(Doubts(slow).empty());
}

TEST_CASE("A coordinate that jumps between few values is that of a target, x or y") {
  const bool is_x = GENERATE(true, false);
  const auto log_with = [&](int values, double jump_m) {
    Trajectory log = Curve();
    for (size_t i = 0; i < log.poses.size(); ++i) {
      StampedPose& pose = log.poses[i];
      pose.yaw_rad = StampedPose::kNotLogged;
      const double step = jump_m * std::floor(values * static_cast<double>(i) /
                                              static_cast<double>(log.poses.size()));
      (is_x ? pose.y_m : pose.x_m) = 0.01 * static_cast<double>(i);
      (is_x ? pose.x_m : pose.y_m) = step;
    }
    return Doubts(log);
  };
  REQUIRE(log_with(4, 0.5).size() == 1);
  CHECK(log_with(4, 0.5)[0] ==
        std::string("its ") + (is_x ? "x" : "y") +
            " has 4 values only and jumps between them, by up to 0.5 m: is it the column of a "
            "target or waypoint?");
  CHECK(log_with(1, 0.5).empty());    // a straight way
  CHECK(log_with(4, 0.019).empty());  // no jump
  CHECK(log_with(12, 0.5).size() == 1);
  CHECK(log_with(13, 0.5).empty());
}

TEST_CASE("A target may jump from the first row to the second and never again") {
  Trajectory log;
  for (int i = 0; i < 20; ++i) {
    log.poses.push_back({.t_s = 0.05 * i, .x_m = i == 0 ? 0.0 : 0.5, .y_m = 0.01 * i});
  }
  REQUIRE(Doubts(log).size() == 1);
  CHECK_THAT(Doubts(log)[0], StartsWith("its x has 2 values only and jumps between them, by up to "
                                        "0.5 m"));
}

TEST_CASE("Two rows are enough to doubt units of time and length") {
  const auto doubt = [](double after_s, double way_m) {
    const std::vector<std::string> doubts =
        Doubts({.poses = {{.t_s = 0.0, .x_m = 0.0}, {.t_s = after_s, .x_m = way_m}}});
    return doubts.size() == 1 ? doubts[0] : "doubts: " + std::to_string(doubts.size());
  };
  CHECK(doubt(1.0, 1.0) == "doubts: 0");
  CHECK_THAT(doubt(5.0, 1.0), StartsWith("its poses are 5 s apart"));
  CHECK_THAT(doubt(1.0, 50.0), StartsWith("it moves at 50 m/s"));
}

TEST_CASE("A piece of the way is longer than a thirtieth of what the path spans") {
  // Every second row is wrong by an eighth of a turn: pieces of one step begin at all rows, those
  // of two have a wrong one in their middle.
  const auto doubts = [](int steps) {
    Trajectory log;
    for (int i = 0; i <= steps; ++i) {
      log.poses.push_back({.t_s = 0.05 * i, .x_m = 0.01 * i, .yaw_rad = i % 2 * kPi / 4.0});
    }
    return Doubts(log).size();
  };
  CHECK(doubts(29) == 0);
  CHECK(doubts(31) == 1);
}

TEST_CASE("A robot that lies on its side is a mistake of angles, by roll or by pitch") {
  for (const bool is_roll : {true, false}) {
    const auto tilted = [is_roll](double tilt_rad) {
      return DoubtsOf([=](StampedPose& p) { (is_roll ? p.roll_rad : p.pitch_rad) = tilt_rad; });
    };
    CHECK(tilted(0.79).empty());
    CHECK(tilted(-0.79).empty());
    REQUIRE(tilted(0.81).size() == 1);
    CHECK_THAT(tilted(-0.81)[0],
               StartsWith("the robot lies on its side, 0.81 rad of roll or pitch"));
  }
  CHECK(DoubtsOf([](StampedPose& p) { p.roll_rad = 2.0 * kPi; }).empty());  // the same as upright
  CHECK(DoubtsOf([](StampedPose& p) { p.roll_rad = 1.5; }, true).empty());  // a drone may
  CHECK(
      DoubtsOf([](StampedPose& p) { p.roll_rad = p.pitch_rad = StampedPose::kNotLogged; }).empty());
}

/// A straight way in `steps` steps of 15 mm, its yaw off by so much.
std::vector<std::string> DoubtsOfStraight(int steps, double off_rad) {
  Trajectory log;
  for (int i = 0; i <= steps; ++i) {
    log.poses.push_back({.t_s = 0.05 * i, .x_m = 0.015 * i, .yaw_rad = off_rad});
  }
  return Doubts(log);
}

TEST_CASE("A yaw contradicts where twice the cosine of its error is at most 0.4, of ten pieces") {
  CHECK(DoubtsOfStraight(60, 0.575).empty());  // cos 1.15 = 0.408
  CHECK(DoubtsOfStraight(60, 0.585).size() == 1);
  CHECK(DoubtsOfStraight(60, -0.575).empty());
  CHECK(DoubtsOfStraight(60, -0.585).size() == 1);
  // A piece is longer than a thirtieth of the way: here each step.
  CHECK(DoubtsOfStraight(9, 0.7).empty());
  CHECK(DoubtsOfStraight(10, 0.7).size() == 1);
  CHECK(DoubtsOfStraight(16, 0.7).size() == 1);
}

TEST_CASE("A mistake is named where it mends the yaw to within 0.28 rad, else another column") {
  const auto off = [](double more_rad) {
    Trajectory log;
    for (int i = 0; i < 140; ++i) {
      const double turn_rad = 0.04 * i;
      log.poses.push_back({.t_s = 0.05 * i,
                           .x_m = 0.5 * std::sin(turn_rad),
                           .y_m = 0.5 - 0.5 * std::cos(turn_rad),
                           .yaw_rad = turn_rad + kPi / 2.0 + more_rad});
    }
    const std::vector<std::string> doubts = Doubts(log);
    return doubts.size() == 1 ? doubts[0] : "";
  };
  for (const double sign : {1.0, -1.0}) {
    CHECK_THAT(off(sign * 0.24), Contains("a quarter turn off?"));
    CHECK_THAT(off(sign * 0.31), Contains("is it another column?"));
  }
}

TEST_CASE("Times are doubted below a ten-thousandth of a second, and speeds only above") {
  const auto apart = [](double step_s) {
    return DoubtsOf([step_s](StampedPose& p) { p.t_s *= step_s / 0.05; });
  };
  REQUIRE(apart(1.01e-4).size() == 1);
  CHECK_THAT(apart(1.01e-4)[0], StartsWith("it moves at "));
  REQUIRE(apart(0.99e-4).size() == 1);
  CHECK_THAT(apart(0.99e-4)[0], StartsWith("its poses are 9.9e-05 s apart: are its times in "));
}

TEST_CASE("Nine rows within a millimetre may be all there is, ten are doubted") {
  const auto rows = [](int count) {
    Trajectory log;
    for (int i = 0; i < count; ++i) log.poses.push_back({.t_s = 0.05 * i, .x_m = 1e-4 * i});
    return Doubts(log).size();
  };
  CHECK(rows(9) == 0);
  CHECK(rows(10) == 1);
}

TEST_CASE(
    "A target jumps by two centimetres, further than the robot, which takes five places each") {
  const bool is_x = GENERATE(true, false);
  const auto doubts = [&](int places, double step_m, double jump_m) {
    Trajectory log;
    for (int i = 0; i < places; ++i) {
      StampedPose& pose = log.poses.emplace_back();
      pose.t_s = 0.05 * i;
      (is_x ? pose.x_m : pose.y_m) = jump_m * (4 * i / places);
      (is_x ? pose.y_m : pose.x_m) = step_m * i;
    }
    return Doubts(log).size();
  };
  CHECK(doubts(100, 0.01, 0.0205) == 1);
  CHECK(doubts(100, 0.01, 0.0195) == 0);
  CHECK(doubts(100, 0.03, 0.031) == 1);
  CHECK(doubts(100, 0.03, 0.029) == 0);
  CHECK(doubts(20, 0.01, 0.5) == 1);
  CHECK(doubts(19, 0.01, 0.5) == 0);
}

}  // namespace
}  // namespace rift::trajectory
