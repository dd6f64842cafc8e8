#include "rift/trial/trial.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "rift/geometry/pose2.hpp"
#include "rift/trajectory/log.hpp"
#include "support/inputs/fake_robot.hpp"
#include "support/inputs/paper_waypoints.hpp"
#include "support/mirror.hpp"

namespace rift::trial {
namespace {

test::FakeRobot RobotAtStart(test::FakeRobotOptions options = {}) {
  options.world_from_start = control::StartPose(test::PaperWaypoints());
  return test::FakeRobot(options);
}

TrialResult Run(Robot& robot, const TrialOptions& options = {}) {
  return RunTrial(robot, test::PaperWaypoints(), {}, options);
}

bool IsStill(const control::WheelPower& power) { return power == control::WheelPower{}; }

// From `since_s` on, which the spoiled reading must outlast by pose_stale_s, no wheel may turn.
void CheckStillAfter(const TrialResult& result, double since_s) {
  REQUIRE(result.commands.back().t_s > since_s);
  for (const SentCommand& command : result.commands) {
    if (command.t_s > since_s) CHECK(IsStill(command.power));
  }
}

TEST_CASE("A robot without delay reaches every waypoint in order") {
  test::FakeRobot robot = RobotAtStart();
  const TrialResult result = Run(robot);
  CHECK(result.outcome == Outcome::kReached);
  REQUIRE(result.visits.size() == 3);
  double last_s = result.driving_s;
  for (const WaypointVisit& visit : result.visits) {
    REQUIRE(visit.reached_s);
    CHECK(*visit.reached_s > last_s);
    CHECK(*visit.closest_m < 0.05);
    last_s = *visit.reached_s;
  }
  CHECK(last_s == Approx(result.end_s));
  CHECK(robot.stops == 1);
  CHECK(IsStill(robot.power()));
}

struct Listing : Observer {
  void Row(const trajectory::StampedPose& pose, std::span<const double> channels) override {
    rows.push_back(trajectory::RiftRow(pose, channels));
  }
  void Sent(const SentCommand& command) override { commands.push_back(command); }

  std::vector<std::string> rows;
  std::vector<SentCommand> commands;
};

TEST_CASE("An observer is told every row and every command of the result") {
  TrialOptions options;
  options.log_period_s = 0.1;
  test::FakeRobot robot = RobotAtStart();
  Listing listing;
  const TrialResult result = RunTrial(robot, test::PaperWaypoints(), {}, options, &listing);
  std::string text = trajectory::WriteRift({{}, RecordedChannels()});
  for (const std::string& row : listing.rows) text += row;
  CHECK(text == trajectory::WriteRift(result.trajectory));
  REQUIRE(listing.commands.size() == result.commands.size());
  CHECK(listing.commands.back().t_s == result.commands.back().t_s);
}

TEST_CASE("A loop delay like the real robot's still reaches the end") {
  test::FakeRobotOptions options;
  options.command_delay_s = 0.2;
  options.sensing_delay_s = 0.12;
  options.frame_period_s = 0.053;
  test::FakeRobot robot = RobotAtStart(options);
  CHECK(Run(robot).outcome == Outcome::kReached);
}

TEST_CASE("Deciding once for each new pose reaches the end with fewer decisions") {
  test::FakeRobotOptions options;
  options.frame_period_s = 0.053;
  test::FakeRobot often = RobotAtStart(options), seldom = RobotAtStart(options);
  TrialOptions trial;
  const TrialResult each_period = Run(often, trial);
  trial.pace = Pace::kNewPose;
  const TrialResult each_pose = Run(seldom, trial);
  CHECK(each_pose.outcome == Outcome::kReached);
  CHECK(2 * each_pose.limits.decisions < each_period.limits.decisions);
}

TEST_CASE("The log has one row for each new pose with its target and the power decided on it") {
  test::FakeRobotOptions options;
  options.frame_period_s = 0.053;
  test::FakeRobot robot = RobotAtStart(options);
  const TrialResult result = Run(robot);
  const trajectory::Trajectory& log = result.trajectory;
  CHECK(log.poses.size() == Approx(result.end_s / 0.053).margin(2.0));
  CHECK(log.poses.front().target_x_m == -0.0716);
  CHECK(log.poses.back().target_x_m == 0.3832);
  REQUIRE(log.channels.size() == 4);
  for (const trajectory::Channel& channel : log.channels) {
    CHECK(channel.values.size() == log.poses.size());
  }
  for (size_t i = 1; i < log.poses.size(); ++i) CHECK(log.poses[i].t_s > log.poses[i - 1].t_s);
  CHECK(log.channels[0].name == "power_left");
  CHECK(log.channels[0].values.front() == 0.0);
  CHECK(log.channels[0].values[log.poses.size() / 2] > 0.1);
}

TEST_CASE("A log period thins the log and nothing else") {
  test::FakeRobot one = RobotAtStart(), other = RobotAtStart();
  TrialOptions options;
  const TrialResult all = Run(one, options);
  options.log_period_s = 0.1;
  const TrialResult thinned = Run(other, options);
  CHECK(thinned.end_s == all.end_s);
  CHECK(thinned.trajectory.poses.size() * 4 < all.trajectory.poses.size());
}

TEST_CASE("The robot stands still until it has settled") {
  test::FakeRobot robot = RobotAtStart();
  TrialOptions options;
  options.settle_s = 0.7;
  const TrialResult result = Run(robot, options);
  CHECK(result.driving_s == Approx(0.7).margin(0.0201));
  CHECK(result.driving_s >= 0.7 - 1e-9);
}

TEST_CASE("A trial that takes too long ends at its timeout and names the waypoint") {
  test::FakeRobot robot = RobotAtStart();
  TrialOptions options;
  options.timeout_s = 1.5;
  const TrialResult result = Run(robot, options);
  CHECK(result.outcome == Outcome::kTimedOut);
  CHECK(result.reason.find("'wp2'") != std::string::npos);
  CHECK(result.Duration_s() == Approx(1.5).margin(0.0201));
  CHECK(result.visits[0].reached_s.has_value());
  CHECK_FALSE(result.visits[1].reached_s.has_value());
  CHECK(result.visits[1].closest_m.has_value());
  CHECK_FALSE(result.visits[2].closest_m.has_value());
  CHECK(robot.stops == 1);
}

TEST_CASE("Poses that are not a number stop the robot and lose the trial") {
  test::FakeRobot robot = RobotAtStart();
  robot.spoil = [](Sensed& sensed) {
    if (sensed.now_s > 1.0) {
      sensed.pose->world_from_robot.yaw_rad = std::numeric_limits<double>::quiet_NaN();
    }
  };
  TrialOptions options;
  const TrialResult result = Run(robot, options);
  CHECK(result.outcome == Outcome::kLost);
  CHECK(result.poses_refused > 10);
  CheckStillAfter(result, 1.0 + options.pose_stale_s);
  CHECK(result.Duration_s() == Approx(1.0 + options.lost_after_s).margin(0.06));
}

TEST_CASE("A pose that jumps for one frame changes no command") {
  test::FakeRobot clean = RobotAtStart(), jumping = RobotAtStart();
  jumping.spoil = [](Sensed& sensed) {
    if (sensed.now_s > 0.91 && sensed.now_s < 0.93) sensed.pose->world_from_robot.x_m += 0.5;
  };
  const TrialResult one = Run(clean), other = Run(jumping);
  CHECK(other.poses_refused == 1);
  CHECK(other.outcome == Outcome::kReached);
  for (const SentCommand& command : other.commands) {
    CHECK(std::abs(command.power.left) < 0.4);  // the jump would turn the robot round
  }
  CHECK(other.end_s == Approx(one.end_s).margin(0.1));
}

TEST_CASE("A robot carried to another place is believed again after a while") {
  test::FakeRobot robot = RobotAtStart();
  robot.spoil = [](Sensed& sensed) {
    if (sensed.now_s > 1.0) sensed.pose->world_from_robot.y_m += 0.2;
  };
  TrialOptions options;
  options.timeout_s = 3.0;
  const TrialResult result = Run(robot, options);
  CHECK(result.poses_refused > 0);
  CHECK(std::any_of(result.trajectory.poses.begin(), result.trajectory.poses.end(),
                    [](const trajectory::StampedPose& pose) { return pose.y_m > 0.05; }));
}

TEST_CASE("A frozen pose stops the robot and a pose that returns sets it going again") {
  test::FakeRobot robot = RobotAtStart();
  std::optional<PoseMeasurement> frozen;
  robot.spoil = [&frozen](Sensed& sensed) {
    if (sensed.now_s < 0.9 || sensed.now_s > 2.0) return;
    if (!frozen) frozen = sensed.pose;
    sensed.pose = frozen;
  };
  TrialOptions options;
  const TrialResult result = Run(robot, options);
  CHECK(result.outcome == Outcome::kReached);
  CHECK(result.stale_decisions > 20);
  for (const SentCommand& command : result.commands) {
    if (command.t_s > 0.91 + options.pose_stale_s && command.t_s < 1.99) {
      CHECK(IsStill(command.power));
    }
  }
}

TEST_CASE("A robot that is never seen is lost and never driven") {
  test::FakeRobot robot = RobotAtStart();
  robot.spoil = [](Sensed& sensed) { sensed.pose.reset(); };
  const TrialResult result = Run(robot);
  CHECK(result.outcome == Outcome::kLost);
  CHECK(result.driving_s == -1.0);
  CHECK(result.trajectory.poses.empty());
  CHECK(std::all_of(robot.commands.begin(), robot.commands.end(), IsStill));
}

TEST_CASE("A pose from the future is not believed") {
  test::FakeRobot robot = RobotAtStart();
  robot.spoil = [](Sensed& sensed) { sensed.pose->captured_s += 1e6; };
  const TrialResult result = Run(robot);
  CHECK(result.outcome == Outcome::kLost);
  CHECK(result.driving_s == -1.0);
}

/// After a second the robot says so, as its fault or its fall.
void CheckEndsBy(std::optional<std::string> Sensed::*what, const char* words, Outcome outcome) {
  test::FakeRobot robot = RobotAtStart();
  robot.spoil = [&](Sensed& sensed) {
    if (sensed.now_s > 1.0) sensed.*what = words;
  };
  const TrialResult result = Run(robot);
  CHECK(result.outcome == outcome);
  CHECK(result.reason == words);
  CHECK(robot.stops == 1);
}

TEST_CASE("A fault ends the trial with the robot's own words") {
  CheckEndsBy(&Sensed::fault, "the battery is empty", Outcome::kFault);
}

TEST_CASE("A robot that has fallen ends the trial as such, with the robot's own words") {
  CheckEndsBy(&Sensed::fall, "tipped over at (0.1, 0.2) m", Outcome::kFell);
}

TEST_CASE("A clock that stands still or runs back is a fault and no endless loop") {
  for (const double clock_s : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()}) {
    test::FakeRobot robot = RobotAtStart();
    robot.spoil = [clock_s](Sensed& sensed) {
      if (!(sensed.now_s < 0.5)) sensed.now_s = clock_s == 0.0 ? 0.5 : clock_s;
    };
    CHECK(Run(robot).outcome == Outcome::kFault);
    CHECK(robot.stops == 1);
  }
}

TEST_CASE("A tilt that lasts is a fall and a flicker of the tracker is none") {
  test::FakeRobot robot = RobotAtStart();
  robot.spoil = [](Sensed& sensed) {
    const bool flicker = sensed.now_s > 0.81 && sensed.now_s < 0.85;
    if (flicker || sensed.now_s > 1.21) sensed.pose->pitch_rad = -1.3;
  };
  const TrialResult result = Run(robot);
  CHECK(result.outcome == Outcome::kFell);
  CHECK(result.end_s == Approx(1.22 + 0.15).margin(0.03));
}

TEST_CASE("A fall is seen to every side and a tilt below the angle to none") {
  test::OnBothSides("roll", "pitch", [](const test::Side& side) {
    for (const double sign : {1.0, -1.0}) {
      for (const bool is_fall : {true, false}) {
        test::FakeRobot robot = RobotAtStart();
        TrialOptions options;
        const double angle_rad =
            geometry::RadFromDeg(options.fall_angle_deg + (is_fall ? 1.0 : -1.0));
        robot.spoil = [&](Sensed& sensed) {
          if (sensed.now_s < 1.0) return;
          side.In(*sensed.pose, &PoseMeasurement::roll_rad, &PoseMeasurement::pitch_rad) =
              sign * angle_rad;
        };
        CHECK((Run(robot, options).outcome == Outcome::kFell) == is_fall);
      }
    }
  });
}

TEST_CASE("The arena ends on all four sides") {
  test::OnBothSides("x", "y", [](const test::Side& side) {
    for (const bool is_upper : {true, false}) {
      test::FakeRobot robot = RobotAtStart();
      TrialOptions options;
      robot.spoil = [&](Sensed& sensed) {
        if (sensed.now_s < 0.5) return;
        // Slowly, so that it is no jump: 1 m/s.
        const double off_m = (is_upper ? 1.0 : -1.0) * (sensed.now_s - 0.5);
        geometry::Pose2& pose = sensed.pose->world_from_robot;
        side.In(pose, &geometry::Pose2::x_m, &geometry::Pose2::y_m) += off_m;
      };
      const geometry::Pose2 start = control::StartPose(test::PaperWaypoints());
      const double start_m = side.IsFirst() ? start.x_m : start.y_m;
      if (is_upper) {
        side.In(options.arena, &Arena::x_max_m, &Arena::y_max_m) = start_m + 0.15;
      } else {
        side.In(options.arena, &Arena::x_min_m, &Arena::y_min_m) = start_m - 0.15;
      }
      const TrialResult result = Run(robot, options);
      CHECK(result.outcome == Outcome::kLeftArena);
    }
  });
}

TEST_CASE("A robot outside the arena ends the trial") {
  test::FakeRobot robot = RobotAtStart();
  TrialOptions options;
  options.arena.x_max_m = 0.2;
  const TrialResult result = Run(robot, options);
  CHECK(result.outcome == Outcome::kLeftArena);
  CHECK(result.trajectory.poses.back().x_m == Approx(0.2).margin(0.01));
  CHECK(robot.stops == 1);
}

TEST_CASE("An exception of the robot passes through and the robot is stopped") {
  test::FakeRobot robot = RobotAtStart();
  robot.spoil = [](Sensed& sensed) {
    if (sensed.now_s > 1.0) throw std::runtime_error("the port is gone");
  };
  CHECK_THROWS_WITH(Run(robot), "the port is gone");
  CHECK(robot.stops == 1);
  CHECK(IsStill(robot.power()));
}

TEST_CASE("Bad options are refused before the robot moves") {
  test::FakeRobot robot = RobotAtStart();
  TrialOptions options;
  options.control_period_s = 0.0;
  CHECK_THROWS_AS(Run(robot, options), std::invalid_argument);
  options = {};
  options.arena.x_min_m = 1.0;
  options.arena.x_max_m = 0.5;
  CHECK_THROWS_WITH(Run(robot, options), Catch::Contains("arena.x_min_m is 1"));
  CHECK(robot.commands.empty());
}

TEST_CASE("A program that is over says so, and waypoints that were reached say that") {
  control::ProgramOptions options;
  options.power = 0.3;
  options.segments = {{.straight_m = 0.1}};
  const control::Task task = control::Program(options, {}, {});
  test::FakeRobot robot(test::FakeRobotOptions{});
  robot.spoil = [](Sensed& sensed) {  // it is stuck
    if (sensed.pose) sensed.pose->world_from_robot = {};
  };
  const TrialResult blind = RunTrial(robot, task, {}, {});
  CHECK(blind.outcome == Outcome::kReached);
  CHECK(blind.reason == "the program is over");
  test::FakeRobot seeing = RobotAtStart();
  CHECK(Run(seeing).reason == "the last waypoint was reached");
}

TEST_CASE("The result tells which limits mattered") {
  test::FakeRobot robot = RobotAtStart();
  const TrialResult result = Run(robot);
  CHECK(result.limits.decisions > 100);
  CHECK(result.limits.v_min > 0);
  CHECK(result.limits.v_min < result.limits.decisions);
  CHECK(result.limits.w_min > result.limits.decisions / 2);
  CHECK(result.limits.w_max == 0);
  CHECK(result.limits.normalised == 0);
  CHECK(result.limits.largest_raw_v > 0.3);  // the derivative kick of the longest leg
}

TEST_CASE("The same trial twice gives the same bytes") {
  test::FakeRobotOptions options;
  options.command_delay_s = 0.13;
  options.frame_period_s = 0.037;
  test::FakeRobot one = RobotAtStart(options), other = RobotAtStart(options);
  const TrialResult first = Run(one), second = Run(other);
  REQUIRE(first.commands.size() == second.commands.size());
  for (size_t i = 0; i < first.commands.size(); ++i) {
    CHECK(first.commands[i].power == second.commands[i].power);
  }
}

}  // namespace
}  // namespace rift::trial
