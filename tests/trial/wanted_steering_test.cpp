#include "trial/wanted_steering.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <utility>

namespace rift::trial {
namespace {

control::NavigatorOptions Navigator() {
  control::NavigatorOptions navigator;
  navigator.heading = {0.1, 0.0, 0.0};
  navigator.distance = {0.5, 0.0, 0.0};
  navigator.v_min = 0.1;
  navigator.v_max = 0.3;
  navigator.w_min = 0.02;
  navigator.w_max = 0.2;
  navigator.reach_radius_m = 0.05;
  navigator.integral_limit = 0.5;
  return navigator;
}

const SteeringModel kModel{.speed_mps = 1.2, .yaw_rate_rad_s = 25.0};

TEST_CASE("Steering for an error counts the integral at its limit") {
  control::NavigatorOptions navigator = Navigator();
  CHECK(SteeringAt(navigator, 0.5) == Approx(0.05));
  navigator.heading.i = 0.04;
  CHECK(SteeringAt(navigator, 0.5) == Approx(0.05 + 0.02));
}

TEST_CASE("On its circle a robot steers for a quarter turn within its limits") {
  control::NavigatorOptions navigator = Navigator();
  CHECK(OnCircle(navigator, kModel).w == Approx(0.1 * M_PI / 2.0));
  CHECK(OnCircle(navigator, kModel).v == 0.1);
  navigator.w_max = 0.1;
  CHECK(OnCircle(navigator, kModel).w == 0.1);
  navigator = Navigator();
  navigator.w_min = 0.18;
  CHECK(OnCircle(navigator, kModel).w == 0.18);
  // 25 x 0.157 rad/s against 1.2 m/s x distance.p: beyond 3.27 the speed grows to its limit.
  navigator = Navigator();
  navigator.distance.p = 3.2;
  CHECK(OnCircle(navigator, kModel).v == 0.1);
  navigator.distance.p = 3.4;
  CHECK(OnCircle(navigator, kModel).v == 0.3);
}

TEST_CASE("The circle is to the side against which the robot pulls, whichever that is") {
  const control::NavigatorOptions navigator = Navigator();
  CHECK(CircleRadius_m(navigator, kModel) == Approx(1.2 * 0.1 / (25.0 * 0.1 * M_PI / 2.0)));
  for (const double side : {-1.0, 1.0}) {
    SteeringModel model = kModel;
    model.pull_rad_s = 10.0 * side;
    CHECK(TurnAgainstPull_rad_s(model, 0.1, 0.1) == Approx(1.5));
    CHECK(CircleRadius_m(navigator, model) == Approx(1.2 * 0.1 / (25.0 * 0.1 * M_PI / 2.0 - 1.0)));
    CHECK(HoldSteering(model, 0.3) == Approx(0.12));
    model.pull_rad_s = 60.0 * side;
    CHECK(std::isinf(CircleRadius_m(navigator, model)));
  }
}

TEST_CASE("A pull is held by an error, by w_min or the integral alone, or never") {
  control::NavigatorOptions navigator = Navigator();
  CHECK(HoldError_rad(navigator, 0.05) == Approx(0.5));
  CHECK(HoldError_rad(navigator, 0.02) == 0.0);
  CHECK(HoldError_rad(navigator, 0.2) == Approx(2.0));
  CHECK(std::isinf(HoldError_rad(navigator, 0.201)));
  navigator.heading.i = 0.1;  // 0.05 at its limit
  CHECK(HoldError_rad(navigator, 0.15) == Approx(1.0));
  CHECK(HoldError_rad(navigator, 0.05) == 0.0);
  CHECK(HoldError_rad(navigator, 0.04) == 0.0);
  CHECK(std::isinf(HoldError_rad(navigator, 0.201)));
  navigator.heading.p = 0.0;
  CHECK(HoldError_rad(navigator, 0.05) == 0.0);
  CHECK(std::isinf(HoldError_rad(navigator, 0.06)));
}

TEST_CASE("The least steering swings heading and path with the delay and its square") {
  const SteeringSwing swing = SwingOf(Navigator(), kModel, 0.2);
  CHECK(swing.heading_rad == Approx(25.0 * 0.02 * 0.2));
  CHECK(swing.path_m == Approx(0.5 * 1.2 * 0.1 * swing.heading_rad * 0.2));
}

TEST_CASE("Stable gains leave sixty degrees at their crossover and keep d in proportion") {
  control::NavigatorOptions navigator = Navigator();
  const control::PidGains p_alone = StableGains(navigator, 25.0, 0.2);
  const double crossover_rad_s = M_PI / 6.0 / 0.2;
  CHECK(p_alone.p == Approx(crossover_rad_s / 25.0));
  CHECK(p_alone.i == 0.0);
  CHECK(p_alone.d == 0.0);
  CHECK(MarginsOf(p_alone, 25.0, 0.2).phase_margin_deg == Approx(60.0));
  navigator.heading.d = 0.005;  // d over p is 0.05 s
  const control::PidGains with_d = StableGains(navigator, 25.0, 0.2);
  CHECK(with_d.d / with_d.p == Approx(0.05));
  CHECK(25.0 * std::hypot(with_d.p, crossover_rad_s * with_d.d) == Approx(crossover_rad_s));
  navigator.heading.d = 0.05;  // and at most half of the delay
  CHECK(StableGains(navigator, 25.0, 0.2).d / StableGains(navigator, 25.0, 0.2).p == Approx(0.1));
  navigator.heading.p = 0.0;
  CHECK(StableGains(navigator, 25.0, 0.2).d == 0.0);
}

TEST_CASE("A pull is met by more gain, then by less speed, then by a higher limit") {
  SteeringModel model = kModel;
  model.pull_rad_s = -20.0;  // at v 0.3 w 0.24 holds it
  control::NavigatorOptions wanted = Navigator();
  HoldAgainstPull(model, {}, {0.3, 0.0, 0.06}, wanted);
  CHECK(wanted.heading.p == Approx(0.3));  // 0.24 / 0.5 is beyond what is stable
  CHECK(wanted.heading.d == Approx(0.06));
  CHECK(wanted.v_max == Approx(0.3 * 0.5 * 25.0 / 20.0));
  CHECK(wanted.v_min == 0.1);
  CHECK(wanted.w_max == Approx(2.0 * 20.0 * wanted.v_max / 25.0));
  // Not below what turns the wheels.
  wanted = Navigator();
  HoldAgainstPull(model, {.dead_band = 0.2}, {0.3, 0.0, 0.0}, wanted);
  CHECK(wanted.v_max == Approx(0.24));
  // A gain that is large enough stays.
  wanted = Navigator();
  wanted.heading.p = 0.6;
  HoldAgainstPull(model, {}, {0.7, 0.0, 0.0}, wanted);
  CHECK(wanted.heading.p == 0.6);
  CHECK(wanted.v_max == 0.3);
}

TEST_CASE("What the integral holds of a pull needs neither gain nor a lower speed") {
  SteeringModel model = kModel;
  model.pull_rad_s = -20.0;  // at v 0.3 w 0.24 holds it
  control::NavigatorOptions wanted = Navigator();
  wanted.heading.i = 0.2;  // 0.1 at its limit: 0.14 is left
  HoldAgainstPull(model, {}, {0.3, 0.0, 0.0}, wanted);
  CHECK(wanted.heading.p == Approx(0.28));
  CHECK(wanted.v_max == Approx(0.3));
  CHECK(wanted.w_max == Approx(0.48));
  // Where less gain is stable the speed is that of both.
  wanted = Navigator();
  wanted.heading.i = 0.2;
  HoldAgainstPull(model, {}, {0.2, 0.0, 0.0}, wanted);
  CHECK(wanted.heading.p == Approx(0.2));
  CHECK(wanted.v_max == Approx((0.2 * 0.5 + 0.1) * 25.0 / 20.0));
  CHECK(HoldError_rad(wanted, HoldSteering(model, wanted.v_max)) == Approx(0.5));
  // An integral that holds all of it changes neither.
  wanted = Navigator();
  wanted.heading.i = 0.6;
  HoldAgainstPull(model, {}, {0.3, 0.0, 0.0}, wanted);
  CHECK(wanted.heading.p == 0.1);
  CHECK(wanted.v_max == 0.3);
}

TEST_CASE("A circle is tightened by gain, by limit, by speed, and the radius grows last") {
  control::NavigatorOptions wanted = Navigator();
  wanted.heading.p = 0.02;
  // 1.2 x 0.1 / 0.04 m is 3 rad/s: w 0.12.
  TightenCircle(kModel, {}, {1.0, 0.0, 0.1}, wanted);
  CHECK(wanted.heading.p == Approx(0.12 / (M_PI / 2.0)));
  CHECK(wanted.heading.d == Approx(0.1 * wanted.heading.p));
  CHECK(wanted.w_max == 0.2);
  CHECK(wanted.v_min == 0.1);
  CHECK(wanted.reach_radius_m == 0.05);
  wanted = Navigator();
  wanted.heading.p = 0.02;
  wanted.w_max = 0.05;
  TightenCircle(kModel, {}, {1.0, 0.0, 0.0}, wanted);
  CHECK(wanted.w_max == Approx(0.12));
  // Half of that gain is stable: half the speed.
  wanted = Navigator();
  wanted.heading.p = 0.02;
  const double half = 0.06 / (M_PI / 2.0);
  TightenCircle(kModel, {}, {half, 0.0, 0.0}, wanted);
  CHECK(wanted.heading.p == Approx(half));
  CHECK(wanted.v_min == Approx(0.05));
  CHECK(wanted.reach_radius_m == Approx(0.05));
  // The wheels turn from 0.08 on: the rest is the radius.
  wanted = Navigator();
  wanted.heading.p = 0.02;
  TightenCircle(kModel, {.dead_band = 0.08 / 1.2}, {half, 0.0, 0.0}, wanted);
  CHECK(wanted.v_min == Approx(0.08));
  CHECK(wanted.reach_radius_m == Approx(1.2 * 0.08 / (25.0 * 0.06) / 0.8));
}

TEST_CASE("The distance loop asks for no more speed than the circle turns with, and stays if so") {
  // w 0.12 turns by 3 rad/s: 0.8 x 3 over 1.2 m/s.
  for (const auto& [was, wanted_p] : {std::pair(2.5, 2.0), {2.1, 2.0}, {1.9, 1.9}}) {
    control::NavigatorOptions wanted = Navigator();
    wanted.heading.p = 0.12 / (M_PI / 2.0);
    wanted.distance.p = was;
    TightenCircle(kModel, {}, {1.0, 0.0, 0.0}, wanted);
    INFO(was);
    CHECK(wanted.distance.p == Approx(wanted_p));
    CHECK(wanted.reach_radius_m == Approx(0.05));
  }
}

TEST_CASE("A strong pull to either side takes the least speed down with the largest one") {
  for (const double side : {1.0, -1.0}) {
    SteeringModel model = kModel;
    model.pull_rad_s = 40.0 * side;
    control::NavigatorOptions wanted = Navigator();
    wanted.heading.i = 0.01;
    HoldAgainstPull(model, {}, {0.3, 0.0, 0.0}, wanted);
    const double v = 0.3 * 0.5 * 25.0 / 40.0 + 0.005 * 25.0 / 40.0;
    CHECK(wanted.v_max == Approx(v));
    CHECK(wanted.v_min == Approx(v));
    CHECK(wanted.heading.i == 0.01);
    CHECK(wanted.w_max == Approx(0.31));  // twice what holds it, 0.155
  }
}

TEST_CASE("A circle is tightened against a pull to either side") {
  for (const double side : {1.0, -1.0}) {
    SteeringModel model = kModel;
    model.pull_rad_s = 10.0 * side;
    control::NavigatorOptions wanted = Navigator();
    wanted.heading = {0.02, 0.01, 0.0};
    wanted.integral_limit = 0.0;
    wanted.distance.p = 3.0;
    TightenCircle(model, {}, {1.0, 0.0, 0.2}, wanted);
    // At v 0.1 3 rad/s for the circle and 1 against the pull are w 0.16.
    CHECK(wanted.heading.p == Approx(0.16 / (M_PI / 2.0)));
    CHECK(wanted.heading.i == 0.01);
    CHECK(wanted.heading.d == Approx(0.2 * wanted.heading.p));
    CHECK(wanted.w_max == 0.2);
    CHECK(wanted.v_min == 0.1);
    CHECK(wanted.distance.p == Approx(0.8 * 3.0 / 1.2));
    CHECK(wanted.reach_radius_m == Approx(0.05));
    // What pulls harder than anything turns is left as it is.
    model.pull_rad_s = 300.0 * side;
    wanted = Navigator();
    TightenCircle(model, {.dead_band = 0.1}, {0.1, 0.0, 0.0}, wanted);
    CHECK(wanted.distance.p == 0.5);
    CHECK(wanted.reach_radius_m == 0.05);
  }
}

TEST_CASE("No steering is wanted beyond what the wheels have left beside the least speed") {
  control::NavigatorOptions wanted = Navigator();
  wanted.v_min = wanted.v_max = 0.9;
  wanted.w_max = 0.05;
  TightenCircle(kModel, {}, {1.0, 0.0, 0.0}, wanted);
  CHECK(wanted.heading.p == Approx(0.9 * 1.2 / 0.04 / 25.0 / (M_PI / 2.0)));
  CHECK(wanted.w_max == Approx(0.1));
  CHECK(wanted.v_min == Approx(0.04 * 25.0 * 0.1 / 1.2));
  CHECK(wanted.reach_radius_m == Approx(0.05));
}

TEST_CASE("The time a task needs is twice its legs and its turns, and the time to settle") {
  control::Task task;
  task.waypoints = {{"a", 0.0, 0.0}, {"b", 3.0, 0.0}, {"c", 3.0, 4.0}};
  control::NavigatorOptions navigator = Navigator();
  navigator.v_min = navigator.v_max = 0.25;
  TrialOptions options;
  options.settle_s = 0.7;
  const double turn_s = M_PI / (25.0 * 0.1 * M_PI / 2.0) + 2.0 * 0.2;
  CHECK(NeededTime_s(task, navigator, kModel, 0.2, options) ==
        Approx(2.0 * (7.0 / 0.3 + 2.0 * turn_s) + 0.7));
  // v follows the distance between its limits: 0.1 below 0.2 m, 0.3 beyond 0.6 m.
  task.waypoints = {{"a", 0.0, 0.0}, {"b", 1.0, 0.0}};
  const double way_s = (0.2 / 0.1 + std::log(0.6 / 0.2) / 0.5 + 0.4 / 0.3) / 1.2;
  CHECK(NeededTime_s(task, Navigator(), kModel, 0.2, options) ==
        Approx(2.0 * (way_s + turn_s) + 0.7).epsilon(0.002));
  // Of a hundred parts of a leg, at the speed of the middle of each.
  double parts_s = 0.0;
  for (int part = 0; part < 100; ++part) {
    parts_s += 0.01 / (1.2 * std::clamp(0.5 * (0.005 + 0.01 * part), 0.1, 0.3));
  }
  CHECK(NeededTime_s(task, Navigator(), kModel, 0.2, options) ==
        Approx(2.0 * (parts_s + turn_s) + 0.7).epsilon(1e-9));
}

TEST_CASE("A wheel turns from the larger of dead band and breakaway on, evenly a fifth above") {
  SteeringPrior prior{.dead_band = 0.1, .breakaway_power = 0.15};
  CHECK(prior.MovingPower() == 0.15);
  CHECK(prior.LeastPower() == Approx(0.18));
  prior.dead_band = 0.2;
  CHECK(prior.MovingPower() == 0.2);
}

}  // namespace
}  // namespace rift::trial
