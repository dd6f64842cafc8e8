// When a trial ends and when its robot is told to stand, just inside and just outside of each rule.
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <vector>

#include "rift/geometry/pose2.hpp"
#include "rift/trial/trial.hpp"

namespace rift::trial {
namespace {

constexpr double kPeriod_s = 0.125;  // powers of two: times are exact

/// Stands at the origin, is seen in every period, and says what it is told to.
class Scripted : public Robot {
 public:
  Sensed Sense() override {
    Sensed sensed{.now_s = now_s};
    if (!unseen(now_s)) {
      sensed.pose = PoseMeasurement{.captured_s = now_s - age_s, .world_from_robot = at};
      sensed.pose->roll_rad = roll_rad(now_s);
      sensed.pose->pitch_rad = pitch_rad(now_s);
    }
    return sensed;
  }
  void Command(const control::WheelPower& power) override {
    drives.push_back(power.left != 0.0 || power.right != 0.0);
  }
  void Advance(double dt_s) override { now_s += dt_s; }
  void Stop() noexcept override { ++stops; }

  double now_s = 4.0, age_s = 0.0;
  geometry::Pose2 at;
  std::function<bool(double)> unseen = [](double) { return false; };
  std::function<double(double)> roll_rad = [](double) { return 0.0; }, pitch_rad = roll_rad;
  std::vector<bool> drives;
  int stops = 0;
};

TrialOptions Options() {
  TrialOptions options;
  options.control_period_s = kPeriod_s;
  options.settle_s = 0.25;
  options.timeout_s = 4.0;
  options.pose_stale_s = 0.5;
  options.lost_after_s = 1.0;
  options.fall_confirm_s = 0.25;
  return options;
}

TrialResult Run(Scripted& robot, const TrialOptions& options = Options()) {
  return RunTrial(robot, std::vector<control::Waypoint>{{.name = "s"}, {.name = "far", .x_m = 5.0}},
                  {}, options);
}

TEST_CASE("A waypoint without a name that is not reached is told by its place in the task") {
  Scripted robot;
  const std::vector<control::Waypoint> task{{}, {.x_m = 5.0}};
  CHECK_THAT(RunTrial(robot, task, {}, Options()).reason,
             Catch::StartsWith("waypoints[1] was not reached within trial.timeout_s, 4 s"));
}

TEST_CASE("A trial ends at its timeout, on the robot's clock, and drives once it has settled") {
  Scripted robot;
  const TrialResult result = Run(robot);
  CHECK(result.outcome == Outcome::kTimedOut);
  CHECK(result.start_s == 4.0);
  CHECK(result.end_s == 8.0);
  CHECK(result.driving_s == 4.25);
  CHECK(robot.drives.size() == 32);
  CHECK_FALSE(robot.drives[1]);
  CHECK(robot.drives[2]);
  CHECK(robot.stops == 1);
  CHECK(result.reason ==
        "waypoint 'far' was not reached within trial.timeout_s, 4 s; control.v_min is 0.15, "
        "control.v_max 0.3");
  CHECK(result.trajectory.poses.size() == 32);
  CHECK(result.pose_age_s == 0.0);
}

TEST_CASE(
    "A pose is too old to decide by beyond pose_stale_s, and the robot lost beyond lost_after_s") {
  Scripted robot;
  robot.unseen = [](double now_s) { return now_s > 5.0; };
  const TrialResult result = Run(robot);
  CHECK(result.outcome == Outcome::kLost);
  CHECK(result.end_s == 5.0 + 1.125);
  CHECK(result.reason == "no believable pose for 1.12 s");
  // Decisions at 5.0 ... 5.5 drive, those at 5.625 ... 6.0 stand.
  REQUIRE(robot.drives.size() == 17);
  CHECK(robot.drives[12]);
  for (size_t i = 13; i < 17; ++i) CHECK_FALSE(robot.drives[i]);
  CHECK(result.stale_decisions == 4);
  TrialOptions longer = Options();
  longer.lost_after_s = 1.125;
  Scripted other;
  other.unseen = robot.unseen;
  CHECK(Run(other, longer).end_s == 5.0 + 1.25);
}

TEST_CASE("A robot that nobody has seen is as old as the trial") {
  Scripted robot;
  robot.unseen = [](double) { return true; };
  const TrialResult result = Run(robot);
  CHECK(result.outcome == Outcome::kLost);
  CHECK(result.end_s == 4.0 + 1.125);
  CHECK(result.driving_s == -1.0);
  CHECK(result.trajectory.poses.empty());
}

TEST_CASE(
    "A tilt beyond the angle is a fall once it has lasted, by roll and by pitch, to any side") {
  for (const bool is_roll : {true, false}) {
    for (const double side : {1.0, -1.0}) {
      for (const double beyond_deg : {0.1, -0.1}) {
        Scripted robot;
        const auto tilted = [=](double now_s) {
          return now_s >= 5.0 ? side * geometry::RadFromDeg(60.0 + beyond_deg) : 0.0;
        };
        (is_roll ? robot.roll_rad : robot.pitch_rad) = tilted;
        const TrialResult result = Run(robot);
        INFO(is_roll << " " << side << " " << beyond_deg);
        CHECK((result.outcome == Outcome::kFell) == (beyond_deg > 0.0));
        if (beyond_deg < 0.0) continue;
        CHECK(result.end_s == 5.25);
        CHECK(result.reason == "roll or pitch stayed beyond 60 deg from 5.000 s on");
      }
    }
  }
  Scripted flickers;  // never two periods on end
  flickers.roll_rad = [](double now_s) {
    return std::fmod(now_s, 0.25) == 0.0 ? geometry::RadFromDeg(90.0) : 0.0;
  };
  CHECK(Run(flickers).outcome == Outcome::kTimedOut);
}

TEST_CASE("A pose from a period ahead of the clock is believed, and none from further ahead") {
  Scripted robot;
  robot.age_s = -kPeriod_s;
  CHECK(Run(robot).outcome == Outcome::kTimedOut);
  Scripted ahead;
  ahead.age_s = -kPeriod_s - 0.001;
  const TrialResult result = Run(ahead);
  CHECK(result.outcome == Outcome::kLost);
  CHECK(result.poses_refused > 0);
  CHECK(result.refused_moves == 0);
}

TEST_CASE("A robot outside the arena is told with its place") {
  Scripted robot;
  robot.at = {0.25, -0.5, 0.0};
  TrialOptions options = Options();
  options.arena.x_max_m = 0.25;
  CHECK(Run(robot, options).outcome == Outcome::kTimedOut);
  options.arena.y_min_m = -0.25;
  Scripted outside;
  outside.at = robot.at;
  const TrialResult result = Run(outside, options);
  CHECK(result.outcome == Outcome::kLeftArena);
  CHECK(result.reason == "the robot is at x 0.250 m, y -0.500 m, outside the arena");
  CHECK(result.end_s == 4.0);
  CHECK(outside.drives.empty());
}

/// Pictures every half second.
class Filmed : public Scripted {
 public:
  Sensed Sense() override {
    age_s = now_s - 0.5 * std::floor(2.0 * now_s);
    return Scripted::Sense();
  }
};

TEST_CASE("Decided once for each picture, a robot keeps its power until the next one") {
  TrialOptions options = Options();
  options.pace = Pace::kNewPose;
  Filmed robot;
  const TrialResult result = Run(robot, options);
  CHECK(result.limits.decisions == 7);  // at 4.5, 5.0 ... 7.5 s
  CHECK(result.trajectory.poses.size() == 8);
  REQUIRE(robot.drives.size() == 32);
  for (size_t i = 0; i < 32; ++i) CHECK(robot.drives[i] == (i >= 4));
  CHECK(result.pose_age_s == 0.0);
  options.pace = Pace::kEveryPeriod;
  Filmed often;
  CHECK(Run(often, options).limits.decisions == 30);  // from 4.25 s on
}

/// The steering that is sent, to a waypoint 45 degrees to the left (1) or to the right (-1).
std::vector<double> SteeringOf(Scripted& robot, double side,
                               const control::NavigatorOptions& navigator,
                               const TrialOptions& options) {
  std::vector<double> w;
  const std::vector<control::Waypoint> task{{.name = "s"}, {.x_m = 5.0, .y_m = 5.0 * side}};
  for (const SentCommand& sent : RunTrial(robot, task, navigator, options).commands) {
    w.push_back(0.5 * (sent.power.right - sent.power.left));
  }
  return w;
}

TEST_CASE("The first decision counts for one period, each other for the time since the last") {
  control::NavigatorOptions navigator;
  navigator.heading = {0.0, 0.1, 0.0};
  navigator.w_min = 0.0;
  navigator.dt_max_s = 1.0;
  navigator.integral_limit = 100.0;
  TrialOptions options = Options();
  for (const double side : {1.0, -1.0}) {
    const double rate = 0.1 * side * std::atan(1.0);  // of w, in each second
    options.pace = Pace::kEveryPeriod;
    Scripted often;
    const std::vector<double> each_period = SteeringOf(often, side, navigator, options);
    REQUIRE(each_period.size() == 32);
    CHECK(each_period[2] == Approx(rate * 0.125));
    CHECK(each_period[3] == Approx(rate * 0.25));
    CHECK(each_period[31] == Approx(rate * 30 * 0.125));
    options.pace = Pace::kNewPose;
    Filmed seldom;
    const std::vector<double> each_picture = SteeringOf(seldom, side, navigator, options);
    REQUIRE(each_picture.size() == 32);
    CHECK(each_picture[4] == Approx(rate * 0.125));
    CHECK(each_picture[7] == Approx(rate * 0.125));
    CHECK(each_picture[8] == Approx(rate * 0.625));
    CHECK(each_picture[12] == Approx(rate * 1.125));
  }
}

TEST_CASE(
    "What was sent and is not seen yet is counted where the delay of the loop is made up for") {
  control::NavigatorOptions navigator;
  navigator.heading = {0.1, 0.0, 0.0};
  navigator.w_min = 0.0;
  for (const double side : {1.0, -1.0}) {
    const double asked = 0.1 * side * std::atan(1.0);
    for (const double delay_s : {0.0, 0.3}) {
      navigator.latency.delay_s = delay_s;
      Scripted robot;
      const std::vector<double> w = SteeringOf(robot, side, navigator, Options());
      CHECK(w[1] == 0.0);
      CHECK(w[2] == Approx(asked));
      // 29 rad/s for each unit of w: a period turns it by a third of the error.
      if (delay_s > 0.0) CHECK(w[3] / asked < 0.75);
      if (delay_s > 0.0) CHECK(w[3] / asked > 0.55);
      if (delay_s == 0.0) CHECK(w[3] == Approx(asked));
    }
  }
}

TEST_CASE("Ages are those of the poses that were decided on, and of those that came in") {
  Scripted robot;
  robot.age_s = 0.25;
  const TrialResult result = Run(robot);
  CHECK(result.pose_age_s == 0.25);
  CHECK(result.arrival_age_s == 0.25);
}

TEST_CASE("A clock may run twenty times slower than asked, and then is a fault") {
  /// Time goes on by so much of each period.
  class Slow : public Scripted {
   public:
    explicit Slow(double share) : share_(share) {}
    void Advance(double dt_s) override { now_s += share_ * dt_s; }

   private:
    double share_;
  };
  // Turns are held to be a tenth of a second at most: 810 of them may pass in 20 times 4 s and one.
  Slow slow(1.0 / 25.0);  // 800
  CHECK(Run(slow).outcome == Outcome::kTimedOut);
  Slow slower(1.0 / 25.5);  // 816
  const TrialResult result = Run(slower);
  CHECK(result.outcome == Outcome::kFault);
  CHECK(result.reason == "the robot's clock stands still or runs backwards");
  Slow back(-1.0);
  CHECK(Run(back).outcome == Outcome::kFault);
}

TEST_CASE("Turns that new pictures end early are no clock that stands still") {
  class Early : public Scripted {
   public:
    void Advance(double) override { now_s += 1.0 / 32.0; }
  };
  Early robot;
  TrialOptions options = Options();
  options.control_period_s = 1.0;
  const TrialResult result = Run(robot, options);
  CHECK(result.outcome == Outcome::kTimedOut);
  CHECK(result.Duration_s() == 4.0);
}

TEST_CASE("A refused pose is counted by the limit of the gate that it broke, or by none") {
  /// One pose, at 5 s, is elsewhere, or of another time.
  class Jumping : public Scripted {
   public:
    explicit Jumping(const PoseMeasurement& jump) : jump_(jump) { at = {1.0, 2.0, 3.1}; }
    Sensed Sense() override {
      return now_s == 5.0 ? Sensed{.now_s = now_s, .pose = jump_} : Scripted::Sense();
    }

   private:
    PoseMeasurement jump_;
  };
  using Counts = std::array<size_t, 3>;
  const auto refused = [](double move_m, double turned_rad, double captured_s = 5.0,
                          double min_interval_s = 0.01) {
    control::NavigatorOptions navigator;
    navigator.pose_gate.max_speed_mps = 1.0;
    navigator.pose_gate.max_yaw_rate_rad_s = 2.0;
    navigator.pose_gate.min_interval_s = min_interval_s;
    Jumping robot({.captured_s = captured_s,
                   .world_from_robot = {1.0 + 0.6 * move_m, 2.0 - 0.8 * move_m,
                                        geometry::WrapToPi(3.1 + turned_rad)}});
    const TrialResult result =
        RunTrial(robot, std::vector<control::Waypoint>{{.name = "s"}, {.name = "far", .x_m = 5.0}},
                 navigator, Options());
    return Counts{result.poses_refused, result.refused_moves, result.refused_turns};
  };
  // An eighth of a second after the pose before: 0.125 m and 0.25 rad, across half a turn.
  CHECK(refused(0.124, 0.249) == Counts{0, 0, 0});
  CHECK(refused(0.126, 0.0) == Counts{1, 1, 0});
  CHECK(refused(0.0, 0.251) == Counts{1, 0, 1});
  CHECK(refused(0.0, -0.251) == Counts{1, 0, 1});
  CHECK(refused(0.126, 0.251) == Counts{1, 1, 1});
  // Poses nearer in time than the least interval are held to that.
  CHECK(refused(0.249, 0.499, 5.0, 0.25) == Counts{0, 0, 0});
  CHECK(refused(0.251, 0.501, 5.0, 0.25) == Counts{1, 1, 1});
  CHECK(refused(0.251, 0.499, 5.0, 0.25) == Counts{1, 1, 0});
  CHECK(refused(9.0, 1.0, 4.75) == Counts{1, 0, 0});
  CHECK(refused(std::nan(""), 0.0) == Counts{1, 0, 0});
}

TEST_CASE("Options that would never end a trial, or contradict each other, are refused") {
  Scripted robot;
  TrialOptions options = Options();
  options.timeout_s = 0.0;
  CHECK_THROWS_WITH(Run(robot, options),
                    "control_period_s is 0.125 and timeout_s 0, and both must be above zero");
  options = Options();
  options.control_period_s = 0.0;
  CHECK_THROWS_WITH(Run(robot, options), Catch::StartsWith("control_period_s is 0 and"));
  options = Options();
  options.pose_stale_s = 1.5;
  CHECK_THROWS_WITH(Run(robot, options),
                    "pose_stale_s is 1.5, and it must not exceed lost_after_s, which is 1");
  options = Options();
  options.pose_stale_s = options.lost_after_s;
  CHECK_NOTHROW(Run(robot, options));
  options.arena.y_min_m = options.arena.y_max_m = 0.5;
  CHECK_THROWS_WITH(Run(robot, options),
                    "arena.y_min_m is 0.5, and it must be below "
                    "arena.y_max_m, 0.5");
}

TEST_CASE("The defaults of a trial are these") {
  const TrialOptions options;
  CHECK(options.control_period_s == 0.02);
  CHECK(options.settle_s == 0.1);
  CHECK(options.timeout_s == 20.0);
  CHECK(options.pose_stale_s == 0.4);
  CHECK(options.lost_after_s == 2.0);
  CHECK(options.fall_angle_deg == 60.0);
  CHECK(options.fall_confirm_s == 0.15);
  CHECK(options.log_period_s == 0.0);
  CHECK(options.pace == Pace::kEveryPeriod);
}

}  // namespace
}  // namespace rift::trial
