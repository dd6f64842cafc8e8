#include "rift/control/navigator.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "rift/geometry/pose2.hpp"
#include "support/inputs/paper_waypoints.hpp"

namespace rift::control {
namespace {

constexpr double kStep_s = 0.02;

std::vector<Waypoint> Line(bool stop, double end_m = 2.0) {
  return {{"start", 0.0, 0.0, 0.0, false},
          {"middle", 1.0, 0.0, {}, stop},
          {"end", end_m, 0.0, {}, true}};
}

// The second step on one spot: no derivative is left in it.
Decision Settled(const NavigatorOptions& options, const std::vector<Waypoint>& waypoints,
                 const geometry::Pose2& pose) {
  Navigator navigator(options, waypoints);
  navigator.Step({0.0, kStep_s, 0.0, pose});
  return navigator.Step({kStep_s, kStep_s, kStep_s, pose});
}

TEST_CASE("The forward power is the distance loop within v_min and v_max") {
  const Decision middle = Settled({}, Line(true), {0.8, 0.0, 0.1});
  CHECK(middle.v == Approx(0.9 * 0.2));
  CHECK_FALSE(middle.limits.v_min);
  CHECK_FALSE(middle.limits.v_max);
  const Decision near = Settled({}, Line(true), {0.92, 0.0, 0.1});
  CHECK(near.v == 0.15);
  CHECK(near.limits.v_min);
  CHECK(near.raw_v == Approx(0.9 * 0.08));
  const Decision far = Settled({}, Line(true), {0.0, 0.0, 0.1});
  CHECK(far.v == 0.30);
  CHECK(far.limits.v_max);
  CHECK(far.raw_v == Approx(0.9));
}

TEST_CASE("A target to the left turns left and the least steering has the side of the error") {
  const Decision left = Settled({}, Line(true), {0.5, -0.1, 0.0});
  CHECK(left.heading_error_rad > 0.0);
  CHECK(left.w == 0.02);
  CHECK(left.limits.w_min);
  CHECK(left.power.right - left.power.left == Approx(0.04));
  const Decision right = Settled({}, Line(true), {0.5, 0.1, 0.0});
  CHECK(right.w == -0.02);
  CHECK(right.power.left > right.power.right);
}

TEST_CASE("A heading error beyond half a turn goes the short way") {
  const Decision decision = Settled({}, Line(true), {0.5, 0.0, 3.0 * geometry::kPi - 0.2});
  CHECK(decision.heading_error_rad == Approx(-(geometry::kPi - 0.2)));
  CHECK(decision.w < -0.02);
}

TEST_CASE("Straight ahead asks for no steering at all") {
  const Decision decision = Settled({}, Line(true), {0.5, 0.0, 0.0});
  CHECK(decision.w == 0.0);
  CHECK(decision.power.left == decision.power.right);
}

TEST_CASE("Powers beyond one are scaled together and keep their ratio") {
  NavigatorOptions options;
  options.v_max = 1.0;
  options.heading.p = 10.0;
  const Decision decision = Settled(options, Line(true, 3.0), {0.0, 1.0, 0.0});
  CHECK(decision.v == 1.0);
  CHECK(decision.w == -0.5);
  CHECK(decision.limits.w_max);
  CHECK(decision.limits.normalised);
  CHECK(decision.power.left == Approx(1.0));
  CHECK(decision.power.right == Approx(0.5 / 1.5));
}

TEST_CASE("Cruise speed caps only a robot on its course") {
  NavigatorOptions options;
  options.cruise_speed = 0.2;
  const Decision on_course = Settled(options, Line(true), {0.0, 0.0, 0.1});
  CHECK(on_course.v == 0.2);
  CHECK(on_course.limits.cruise_cap);
  const Decision off_course = Settled(options, Line(true), {0.0, 0.0, 0.3});
  CHECK(off_course.v == 0.3);
  CHECK_FALSE(off_course.limits.cruise_cap);
}

TEST_CASE("A waypoint without stop is approached at cruise speed when on course") {
  CHECK(Settled({}, Line(false), {0.9, 0.0, 0.1}).v == 0.3);
  CHECK(Settled({}, Line(false), {0.9, 0.0, 0.1}).limits.through_cruise);
  CHECK(Settled({}, Line(false), {0.9, 0.0, 0.2}).v == 0.15);
  CHECK(Settled({}, Line(true), {0.9, 0.0, 0.1}).v == 0.15);
}

TEST_CASE("A stop is one decision of zero power and then the next leg begins") {
  Navigator navigator({}, Line(true));
  const Decision at = navigator.Step({0.0, kStep_s, 0.0, {0.96, 0.0, 0.1}});
  CHECK(at.reached);
  CHECK(at.waypoint == 1);
  CHECK(at.power == WheelPower{});
  const Decision next = navigator.Step({kStep_s, kStep_s, kStep_s, {0.96, 0.0, 0.1}});
  CHECK(next.waypoint == 2);
  CHECK(next.v == 0.3);
}

TEST_CASE("A clock that starts anew costs a decision at the start and after each stop") {
  NavigatorOptions options;
  options.clock_starts_anew = true;
  Navigator navigator(options, Line(true));
  const auto step = [&](double x_m, double dt_s = 0.053) {
    return navigator.Step({0.0, dt_s, x_m, {x_m, 0.0, 0.1}});
  };
  CHECK(step(0.0).set_clock);
  const Decision first = step(0.01);
  CHECK_FALSE(first.set_clock);
  CHECK(first.power.left > 0.0);
  // The derivative of the first step that drives is over a true interval.
  CHECK(first.raw_v == Approx(0.99 * (0.9 + 0.01 / 0.053)));
  CHECK(step(0.97).reached);
  const Decision anew = step(0.98);
  CHECK(anew.set_clock);
  CHECK(anew.power == WheelPower{});
  CHECK(step(0.99).power.left > 0.0);
  Navigator through(options, Line(false));
  through.Step({0.0, 0.053, 0.0, {0.0, 0.0, 0.1}});
  CHECK_FALSE(through.Step({0.0, 0.053, 0.1, {0.97, 0.0, 0.1}}).set_clock);
}

TEST_CASE("A clock that the first pose sets costs one decision of a drive") {
  NavigatorOptions options;
  options.first_pose_sets_clock = true;
  Navigator navigator(options, Line(true));
  const auto step = [&](double x_m) { return navigator.Step({0.0, 0.053, x_m, {x_m, 0.0, 0.1}}); };
  const Decision clock = step(0.0);
  CHECK(clock.set_clock);
  CHECK(clock.power == WheelPower{});
  CHECK(step(0.01).power.left > 0.0);
  CHECK(step(0.97).reached);
  const Decision next = step(0.98);
  CHECK_FALSE(next.set_clock);
  CHECK(next.power.left > 0.0);
}

TEST_CASE("A waypoint without stop hands over to the next leg in the same decision") {
  Navigator navigator({}, Line(false));
  const Decision at = navigator.Step({0.0, kStep_s, 0.0, {0.96, 0.0, 0.1}});
  CHECK_FALSE(at.reached);
  CHECK(at.waypoint == 2);
  CHECK(at.v == 0.3);
}

TEST_CASE("After the last waypoint the power stays zero") {
  Navigator navigator({}, Line(true, 1.04));
  navigator.Step({0.0, kStep_s, 0.0, {0.98, 0.0, 0.0}});
  const Decision end = navigator.Step({kStep_s, kStep_s, kStep_s, {1.0, 0.0, 0.0}});
  CHECK(end.finished);
  CHECK(end.reached);
  const Decision after = navigator.Step({1.0, kStep_s, 1.0, {0.5, 0.0, 0.0}});
  CHECK(after.finished);
  CHECK(after.power == WheelPower{});
}

TEST_CASE("Both loops start anew at every waypoint") {
  NavigatorOptions options;
  options.distance.i = 0.1;
  Navigator used(options, Line(true)), fresh(options, Line(true, 2.0));
  for (int i = 0; i < 50; ++i) used.Step({i * kStep_s, kStep_s, i * kStep_s, {0.5, 0.0, 0.2}});
  used.Step({2.0, kStep_s, 2.0, {0.96, 0.0, 0.1}});
  fresh.Step({2.0, kStep_s, 2.0, {0.96, 0.0, 0.1}});
  const PoseInput next{2.02, kStep_s, 2.02, {0.97, 0.0, 0.1}};
  const Decision one = used.Step(next), other = fresh.Step(next);
  CHECK(one.raw_v == other.raw_v);
  CHECK(one.raw_w == other.raw_w);
}

TEST_CASE("Time steps outside their bounds count as the bound") {
  const auto kick_at = [](double dt_s) {
    Navigator navigator({}, Line(true));
    return navigator.Step({0.0, dt_s, 0.0, {0.0, 0.0, 0.5}}).raw_w;
  };
  CHECK(kick_at(0.0) == kick_at(0.005));
  CHECK(kick_at(-1.0) == kick_at(0.005));
  CHECK(kick_at(7.0) == kick_at(0.1));
  CHECK(kick_at(0.05) != kick_at(0.1));
}

TEST_CASE("The slew limit holds each wheel's change from what was really sent") {
  NavigatorOptions options;
  options.slew_rate_per_s = 1.0;
  Navigator navigator(options, Line(true));
  const Decision first = navigator.Step({0.0, kStep_s, 0.0, {0.0, 0.0, 0.0}});
  CHECK(first.power.left == Approx(0.02));
  CHECK(first.limits.slew);
  navigator.NoteSent(0.0, {0.29, 0.29});
  const Decision next = navigator.Step({kStep_s, kStep_s, kStep_s, {0.0, 0.0, 0.0}});
  CHECK(next.power.left == Approx(0.3));
  CHECK_FALSE(next.limits.slew);
}

TEST_CASE("Without a believable pose no wheel turns") {
  Navigator navigator({}, Line(true));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const geometry::Pose2& pose :
       {geometry::Pose2{nan, 0.0, 0.0}, geometry::Pose2{0.0, -1.0 / 0.0, 0.0},
        geometry::Pose2{0.0, 0.0, nan}, geometry::Pose2{1e300, 0.0, 0.0}}) {
    const Decision decision = navigator.Step({0.0, kStep_s, 0.0, pose});
    CHECK(decision.pose_refused);
    CHECK(decision.power == WheelPower{});
  }
}

TEST_CASE("A jump is decided on as if it had not come") {
  Navigator navigator({}, Line(true));
  navigator.Step({0.0, kStep_s, 0.0, {0.2, 0.0, 0.1}});
  const Decision jump = navigator.Step({0.05, kStep_s, 0.05, {0.98, 0.0, 0.1}});
  CHECK(jump.pose_refused);
  CHECK(jump.distance_m == Approx(0.8));
  CHECK_FALSE(navigator.Step({0.1, kStep_s, 0.1, {0.21, 0.0, 0.3}}).pose_refused);
  CHECK(navigator.Step({0.15, kStep_s, 0.15, {0.21, 0.0, 2.8}}).pose_refused);  // turns too fast
  CHECK(navigator.Step({0.2, kStep_s, 0.05, {0.21, 0.0, 0.3}}).pose_refused);   // older
}

TEST_CASE("Options that contradict each other are refused with both names") {
  NavigatorOptions options;
  options.v_min = 0.4;
  CHECK_THROWS_WITH(Navigator(options, Line(true)),
                    Catch::Contains("v_min is 0.4") && Catch::Contains("v_max"));
  options = {};
  options.cruise_speed = 0.1;
  CHECK_THROWS_AS(options.Check(), std::invalid_argument);
  options = {};
  options.heading.d = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_AS(options.Check(), std::invalid_argument);
}

TEST_CASE("Waypoints without a goal or off the map are refused") {
  CHECK_THROWS_AS(Navigator({}, {}), std::invalid_argument);
  CHECK_THROWS_AS(Navigator({}, {{"only", 0.0, 0.0, {}, true}}), std::invalid_argument);
  std::vector<Waypoint> waypoints = Line(true);
  waypoints[1].y_m = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_WITH(Navigator({}, waypoints), Catch::Contains("waypoint 2 'middle'"));
}

TEST_CASE("A start without heading looks at the first goal") {
  std::vector<Waypoint> waypoints = {{"a", 1.0, 1.0, {}, true}, {"b", 1.0, 3.0, {}, true}};
  CHECK(StartPose(waypoints).yaw_rad == Approx(0.5 * geometry::kPi));
  CHECK(StartPose(test::PaperWaypoints()).yaw_rad == Approx(geometry::RadFromDeg(-0.9)));
}

}  // namespace
}  // namespace rift::control
