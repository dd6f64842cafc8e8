#include "rift/gap/goal.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "rift/gap/comparison.hpp"
#include "support/inputs/paths.hpp"

namespace rift::gap {
namespace {

const Goal kGoal{{0.7, 0.0}, 0.05};

trajectory::Trajectory Beside(trajectory::Trajectory path, double y_m) {
  for (trajectory::StampedPose& pose : path.poses) pose.y_m += y_m;
  return path;
}

TEST_CASE("How short of the goal a run stops is no part of the gap on the way") {
  const trajectory::Trajectory whole = test::StraightPath(0.7, 71);
  const trajectory::Trajectory shorter = test::StraightPath(0.66, 67);
  CHECK(Gap(shorter, whole, {}) == Approx(0.04));
  CHECK(WayGap_m(shorter, whole, kGoal, {}) == Approx(0.0).margin(1e-12));
  CHECK(WayGap_m(whole, shorter, kGoal, {}) == Approx(0.0).margin(1e-12));
}

TEST_CASE("What is beside the way counts up to the goal") {
  const trajectory::Trajectory whole = test::StraightPath(0.7, 71);
  const trajectory::Trajectory beside = Beside(test::StraightPath(0.69, 70), 0.03);
  CHECK(WayGap_m(beside, whole, kGoal, {}) == Approx(0.03).margin(1e-9));
}

TEST_CASE("A path that ends outside the radius or beyond the goal is left as it is") {
  const trajectory::Trajectory whole = test::StraightPath(0.7, 71);
  for (const double length_m : {0.6, 0.73}) {
    const trajectory::Trajectory other =
        test::StraightPath(length_m, static_cast<int>(std::lround(100.0 * length_m)) + 1);
    CHECK(WayGap_m(other, whole, kGoal, {}) == Approx(Gap(other, whole, {})));
  }
}

TEST_CASE(
    "The direction of an end is that of its last three centimetres, or of all where it is less") {
  const trajectory::Trajectory whole = test::StraightPath(0.7, 71);
  // A centimetre and a half aside at the end of 0.66 m: three centimetres back are 0.03 m along x.
  trajectory::Trajectory hook = test::StraightPath(0.66, 67);
  for (const double y_m : {0.005, 0.010, 0.015}) {
    hook.poses.push_back(hook.poses.back());
    hook.poses.back().t_s += 0.1;
    hook.poses.back().y_m = y_m;
  }
  trajectory::Trajectory longer = hook;
  const double ahead_x = 2.0 / std::sqrt(5.0), ahead_y = 1.0 / std::sqrt(5.0);
  const double short_m = 0.04 * ahead_x - 0.015 * ahead_y;
  longer.poses.push_back(longer.poses.back());
  longer.poses.back().t_s += 0.1;
  longer.poses.back().x_m += short_m * ahead_x;
  longer.poses.back().y_m += short_m * ahead_y;
  CHECK(WayGap_m(hook, whole, kGoal, {}) == Approx(Gap(longer, whole, {})));
  CHECK(WayGap_m(whole, hook, kGoal, {}) == Approx(Gap(whole, longer, {})));

  const Goal near{{0.04, 0.0}, 0.05};
  CHECK(WayGap_m(test::StraightPath(0.02, 3), test::StraightPath(0.04, 5), near, {}) ==
        Approx(0.0).margin(1e-12));
}

TEST_CASE("The direction in which a path ends is that of its last three centimetres") {
  // Along x and then to the left, in steps of half a millimetre.
  const auto corner = [](double aside_m) {
    trajectory::Trajectory path = test::StraightPath(0.4, 801);
    for (int i = 1; i <= static_cast<int>(std::lround(2000.0 * aside_m)); ++i) {
      path.poses.push_back({.t_s = 100.0 + i, .x_m = 0.4, .y_m = 0.0005 * i});
    }
    return path;
  };
  const auto gap_m = [&](double aside_m) {
    return WayGap_m(corner(aside_m), corner(aside_m + 0.04), {{0.4, aside_m + 0.04}, 0.05}, {});
  };
  CHECK(gap_m(0.0305) == Approx(0.0).margin(1e-9));
  // 28.5 mm to the left and 9.5 mm along x are 30 mm: it goes on by 0.3 ahead of 0.95 to the left.
  CHECK(gap_m(0.0285) > 0.01);
}

TEST_CASE("A run that stops at the very radius goes on, and three centimetres back are enough") {
  const trajectory::Trajectory whole = test::StraightPath(1.0, 9);
  const trajectory::Trajectory shorter = test::StraightPath(0.75, 7);
  const auto gap_m = [&](double radius_m) {
    return WayGap_m(shorter, whole, {{1.0, 0.0}, radius_m}, {});
  };
  CHECK(gap_m(0.25) == Approx(0.0).margin(1e-12));
  CHECK(gap_m(std::nextafter(0.25, 0.0)) == Approx(0.25));
  // To the left by half a metre and then along x by exactly 0.03 m: it goes on along x alone.
  trajectory::Trajectory hook;
  hook.poses = {{.t_s = 0.0, .x_m = -0.03, .y_m = -0.5},
                {.t_s = 1.0, .x_m = -0.03},
                {.t_s = 2.0, .x_m = 0.0}};
  trajectory::Trajectory longer = hook;
  longer.poses.push_back({.t_s = 3.0, .x_m = 0.04});
  const Goal goal{{0.04, 0.0}, 0.05};
  CHECK(WayGap_m(hook, whole, goal, {}) == Approx(Gap(longer, whole, {})));
  CHECK(WayGap_m(hook, longer, goal, {}) == Approx(0.0).margin(1e-12));
}

}  // namespace
}  // namespace rift::gap
