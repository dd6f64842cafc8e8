// What a steady circle tells of a robot: its gain, its pull and its speed, on both sides of each
// rule.
#include "trial/identified_steering.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "rift/geometry/pose2.hpp"
#include "rift/trial/steering_check.hpp"

namespace rift::trial {
namespace {

const SteeringPrior kPrior{{1.2, 25.0, 0.0, 0.0}, 0.1};

/// A run of four seconds at a power of 0.2 forward and so much to the left, by which the robot
/// turned by `turned_rad` and went `way_m`. Its yaw is seen a milliradian to either side in turns,
/// which no steering explains.
TrialResult Circle(double w, double turned_rad, double way_m) {
  TrialResult result;
  result.outcome = Outcome::kTimedOut;
  result.arrival_age_s = 0.3;
  constexpr int kRows = 80;
  geometry::Pose2 at;
  for (int i = 0; i <= kRows; ++i) {
    const double t_s = 0.05 * i, off_rad = i % 2 == 0 ? 1e-3 : -1e-3;
    result.trajectory.poses.push_back({.t_s = t_s,
                                       .x_m = at.x_m,
                                       .y_m = at.y_m,
                                       .yaw_rad = geometry::WrapToPi(at.yaw_rad + off_rad)});
    result.commands.push_back({t_s, {0.2 - w, 0.2 + w}});
    at = at * geometry::Pose2{way_m / kRows, 0.0, turned_rad / kRows};
  }
  return result;
}

IdentifiedSteering Of(const TrialResult& result) { return IdentifySteering(result, kPrior, 0.0); }

TEST_CASE("On a circle the turn tells the gain, and from 0.6 of the robot's own off a pull") {
  for (const double side : {1.0, -1.0}) {
    const double w = 0.08 * side, of_w = 4.0 * w, of_v = 4.0 * 0.2;
    for (const double share : {0.62, 1.0, 1.64}) {
      const IdentifiedSteering found = Of(Circle(w, share * 25.0 * of_w, 0.5));
      INFO(side << " " << share << " r2 " << found.r2);
      CHECK(found.is_identified);
      CHECK_FALSE(found.is_pull_told);
      CHECK(found.model.yaw_rate_rad_s == Approx(share * 25.0).epsilon(2e-3));
      CHECK(found.model.pull_rad_s == 0.0);
    }
    for (const double share : {0.58, 1.69}) {
      const IdentifiedSteering found = Of(Circle(w, share * 25.0 * of_w, 0.5));
      CHECK(found.is_identified);
      CHECK(found.model.yaw_rate_rad_s == 25.0);
      CHECK(found.model.pull_rad_s == Approx((share - 1.0) * 25.0 * of_w / of_v).epsilon(5e-3));
    }
  }
}

TEST_CASE("Less than half a turn tells nothing, nor one against the steering") {
  for (const double side : {1.0, -1.0}) {
    CHECK(Of(Circle(0.035 * side, 3.16 * side, 0.5)).is_identified);
    CHECK_FALSE(Of(Circle(0.035 * side, 3.12 * side, 0.5)).is_identified);
    CHECK_FALSE(Of(Circle(0.035 * side, -4.0 * side, 0.5)).is_identified);
  }
}

TEST_CASE("The speed of a run is its way over what was sent, up to ten times the robot's own") {
  // 0.8 s of full power. Strides of a fifth of a second are chords of 0.25 rad, 0.26 % shorter.
  CHECK(Of(Circle(0.05, 5.0, 0.5)).model.speed_mps == Approx(0.5 / 0.8).epsilon(0.004));
  CHECK(Of(Circle(0.05, 5.0, 9.8 * 1.2 * 0.8)).model.speed_mps == Approx(9.8 * 1.2).epsilon(0.004));
  CHECK(Of(Circle(0.05, 5.0, 10.2 * 1.2 * 0.8)).model.speed_mps == 1.2);
  CHECK(Of(Circle(0.0, 0.0, 0.035)).model.speed_mps == Approx(0.035 / 0.8));
}

TEST_CASE("A run of less than two centimetres tells nothing but the age of its poses") {
  TrialResult run = Circle(0.05, 5.0, 0.019);
  IdentifiedSteering found = Of(run);
  CHECK_FALSE(found.is_identified);
  CHECK(found.model.speed_mps == 1.2);
  CHECK(found.model.pose_age_s == 0.3);
  run.pose_age_s = 0.125;  // of the decisions, where there were any
  CHECK(Of(run).model.pose_age_s == 0.125);
  run.pose_age_s = 0.0;
  CHECK(Of(run).model.pose_age_s == 0.0);
  run.pose_age_s = run.arrival_age_s = -1.0;
  CHECK(Of(run).model.pose_age_s == 0.0);
}

TEST_CASE("A pull that a circle alone tells may be another gain, and that is said") {
  for (const double side : {1.0, -1.0}) {
    const double w = 0.08 * side;
    // 1.8 times the turn that 25 rad/s make of w: 8 rad/s for each unit of v.
    const TrialResult run = Circle(w, 1.8 * 25.0 * 4.0 * w, 0.5);
    const control::Task task = std::vector<control::Waypoint>{{.name = "a"}, {.x_m = 1.0}};
    const SteeringCheck check = CheckSteering(
        [&] {
          TrialResult decided = run;
          decided.limits.decisions = 80;
          return decided;
        }(),
        task, {}, {}, kPrior);
    REQUIRE_FALSE(check.causes.empty());
    CHECK_THAT(check.causes[0],
               Catch::StartsWith(
                   std::string("it pulls to the ") + (side > 0.0 ? "left" : "right") +
                   " by 2.4 rad/s at v 0.3 without steering (a motor or wheel that differs from "
                   "the other, or drags; or it answers to w otherwise than the robot's file says): "
                   "driving straight takes w 0.096, and control.heading.p 0.045 asks for that "
                   "only at a heading error of 12"));
  }
}

/// Ten seconds at v 0.3 and a steering that changes every 0.35 s, which the robot answers so
/// much later by `gain` for each unit of w, and `bias_rad_s` beside it.
TrialResult Weaving(double gain, double bias_rad_s, double delay_s = 0.1) {
  const double steering[] = {0.1, -0.05, 0.15, 0.0, -0.12, 0.05, 0.2, -0.15};
  const auto steering_at = [&](double t_s) {
    return t_s < 0.0 ? 0.0 : steering[static_cast<size_t>(t_s / 0.35) % 8];
  };
  TrialResult result;
  result.outcome = Outcome::kTimedOut;
  for (int i = 0; 0.35 * i < 10.0; ++i) {
    const double w = steering[i % 8];
    result.commands.push_back({0.35 * i, {0.3 - w, 0.3 + w}});
  }
  double yaw_rad = 3.0;  // it passes half a turn
  constexpr double kStep_s = 1e-3;
  for (int i = 0; i <= 10'000; ++i) {
    if (i % 50 == 0) {
      const double t_s = kStep_s * i;
      result.trajectory.poses.push_back(
          {.t_s = t_s, .x_m = 0.15 * t_s, .yaw_rad = geometry::WrapToPi(yaw_rad)});
    }
    yaw_rad += kStep_s * (gain * steering_at(kStep_s * (i + 0.5) - delay_s) + bias_rad_s);
  }
  return result;
}

TEST_CASE("Gain, pull and delay of a weaving run are those it was made with, to either side") {
  for (const double side : {1.0, -1.0}) {
    const IdentifiedSteering found = Of(Weaving(10.0, side * 0.6));
    INFO(side);
    CHECK(found.is_identified);
    CHECK(found.is_pull_told);
    CHECK_FALSE(found.is_reversed);
    CHECK(found.model.yaw_rate_rad_s == Approx(10.0).epsilon(0.03));
    CHECK(found.model.pull_rad_s == Approx(side * 2.0).epsilon(0.05));
    CHECK(found.model.command_delay_s == Approx(0.1).margin(0.01));
    CHECK(found.model.speed_mps == Approx(0.5).epsilon(0.03));
    CHECK(found.r2 > 0.98);
  }
}

TEST_CASE("A delay of the commands is looked for up to a second") {
  CHECK(Of(Weaving(10.0, 0.0, 0.97)).model.command_delay_s == Approx(0.97).margin(0.01));
  CHECK(Of(Weaving(10.0, 0.0, 1.3)).model.command_delay_s <= 1.0);
}

TEST_CASE("Steering is told to be reversed of a run that turned away by a quarter and was late") {
  TrialResult run = Weaving(-10.0, 0.0);
  CHECK(IdentifySteering(run, kPrior, 0.26).is_reversed);
  CHECK_FALSE(IdentifySteering(run, kPrior, 0.24).is_reversed);
  run.outcome = Outcome::kLeftArena;
  CHECK(IdentifySteering(run, kPrior, 0.26).is_reversed);
  run.outcome = Outcome::kReached;
  CHECK_FALSE(IdentifySteering(run, kPrior, 0.26).is_reversed);
  CHECK_FALSE(IdentifySteering(Weaving(10.0, 0.0), kPrior, 0.26).is_reversed);
}

}  // namespace
}  // namespace rift::trial
