// The guard at its limits exactly and a moment beyond, in numbers that binary fractions hold, and
// what it says.

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "rift/geometry/pose2.hpp"
#include "rift/hardware/drive_guard.hpp"
#include "support/mirror.hpp"

namespace rift::hardware {
namespace {

using control::WheelPower;
using test::OnBothSides;
using test::Side;

constexpr double kBeyond = 1.0 / 1024.0;

GuardOptions Options() {
  return {.pose_stale_s = 0.125,
          .control_stale_s = 0.0625,
          .link_lag_s = 0.25,
          .host_stall_s = 0.25,
          .jump_m = 0.125,
          .jump_deg = 60.0,
          .max_speed_mps = 2.0,
          .max_power = 0.75,
          .battery_min_v = 3.5};
}

PoseNews NewsAt(double captured_s, const geometry::Pose2& pose = {}) {
  PoseNews news;
  news.newest = PoseSample{{captured_s, pose, 0.0, 0.0, 0.0}, captured_s, captured_s};
  news.looked_s = captured_s;
  return news;
}

PoseNews Looked(double at_s) {
  PoseNews news;
  news.looked_s = at_s;
  return news;
}

DriveGuard Armed(const geometry::Pose2& pose = {}) {
  DriveGuard guard(Options());
  guard.SeePose(NewsAt(10.0, pose), 10.0);
  guard.Arm(10.0);
  return guard;
}

/// That it has stopped for this reason at this time, and allows nothing.
void CheckStopped(const DriveGuard& guard, StopReason reason, const std::string& text,
                  double at_s) {
  CHECK(guard.state() == DriveState::kStopped);
  CHECK(guard.Allowed() == WheelPower{});
  REQUIRE(guard.stop());
  CHECK(guard.stop()->text == text);
  CHECK(guard.stop()->reason == reason);
  CHECK(guard.stop()->at_s == at_s);
}

TEST_CASE("A pose as old as its limit arms and drives, and an older one does neither") {
  DriveGuard guard(Options());
  guard.SeePose(NewsAt(10.0), 10.0);
  CHECK_THROWS_WITH(guard.Arm(10.125 + kBeyond), "cannot arm: the robot was last seen 0.13 s ago");
  guard.Arm(10.125);
  guard.Command({0.5, -0.25}, 10.125);
  CHECK(guard.Allowed() == WheelPower{0.5, -0.25});
  guard.Tick(10.125, 0.0);
  CHECK(guard.state() == DriveState::kArmed);
  guard.Tick(10.125 + kBeyond, 0.0);
  CheckStopped(guard, StopReason::kPoseStale, "no picture for 0.126 s", 10.125 + kBeyond);

  DriveGuard commanded = Armed();
  commanded.Command({0.0, 0.0625}, 10.125 + kBeyond);
  CheckStopped(commanded, StopReason::kPoseStale, "no picture for 0.126 s", 10.125 + kBeyond);
}

TEST_CASE("Whether pictures come or only the tag is missing is told by the age of the last look") {
  for (const double beyond_s : {0.0, kBeyond}) {
    DriveGuard guard = Armed();
    guard.SeePose(Looked(10.03125), 10.03125);
    guard.Command({0.25, 0.25}, 10.15625 + beyond_s);
    if (beyond_s == 0.0) {
      CheckStopped(guard, StopReason::kTagLost, "the tag was not seen for 0.156 s", 10.15625);
    } else {
      CHECK(guard.stop()->reason == StopReason::kPoseStale);
    }
  }
}

TEST_CASE("A command is in force until its limit and no longer") {
  DriveGuard guard = Armed();
  guard.Command({0.25, 0.5}, 10.0);
  guard.SeePose(NewsAt(10.0625), 10.0625);
  guard.Tick(10.0625, 0.0);
  CHECK(guard.Allowed() == WheelPower{0.25, 0.5});
  guard.Tick(10.0625 + kBeyond, 0.0);
  CheckStopped(guard, StopReason::kControlStale, "no control step for 0.063 s", 10.0625 + kBeyond);
}

TEST_CASE("A link may lag and the process may stand still until the limit and no longer") {
  DriveGuard lagging = Armed();
  lagging.Tick(10.0, 0.25);
  CHECK(lagging.state() == DriveState::kArmed);
  lagging.Tick(10.0, 0.25 + kBeyond);
  CheckStopped(lagging, StopReason::kLinkLagging, "the robot has not answered for 0.25 s", 10.0);

  DriveGuard stalled = Armed();
  stalled.NoteTime(10.25);
  stalled.NoteTime(10.25);
  stalled.NoteTime(10.5);
  CHECK(stalled.state() == DriveState::kArmed);
  stalled.NoteTime(10.75 + kBeyond);
  CheckStopped(stalled, StopReason::kHostStalled, "rift itself stood still for 0.25 s",
               10.75 + kBeyond);
  DriveGuard backwards = Armed();
  backwards.NoteTime(10.0 - kBeyond);
  CHECK(backwards.stop()->reason == StopReason::kHostStalled);
}

TEST_CASE("A robot that stands at zero power needs neither a fresh pose nor a fresh command") {
  DriveGuard guard = Armed();
  guard.Command({}, 10.0);
  for (double now_s = 10.125; now_s < 12.0; now_s += 0.125) guard.Tick(now_s, 0.0);
  CHECK(guard.state() == DriveState::kArmed);
  guard.Command({}, 12.0);
  CHECK(guard.state() == DriveState::kArmed);
}

TEST_CASE("A pose may move by its jump and its speed's way on either axis and to either side") {
  OnBothSides("x", "y", [](const Side& side) {
    for (const double sign : {1.0, -1.0}) {
      // 0.125 m, and 2 m/s for 0.125 s.
      const auto moved = [&](double by_m) {
        geometry::Pose2 pose{0.25, -0.5, 0.0};
        side.In(pose, &geometry::Pose2::x_m, &geometry::Pose2::y_m) += sign * by_m;
        DriveGuard guard = Armed({0.25, -0.5, 0.0});
        guard.SeePose(NewsAt(10.125, pose), 10.125);
        return guard;
      };
      CHECK(moved(0.375).state() == DriveState::kArmed);
      CheckStopped(moved(0.375 + kBeyond), StopReason::kPoseJump,
                   "the pose jumped by 0.376 m and 0 deg within 0.125 s", 10.125);
    }
  });
}

TEST_CASE("A pose may turn by its limit to either side, through half a turn as well") {
  for (const double from_deg : {0.0, 170.0, -170.0, 180.0}) {
    for (const double sign : {1.0, -1.0}) {
      const auto turned = [&](double by_deg) {
        const auto at = [](double deg) {
          return geometry::Pose2{0.0, 0.0, geometry::WrapToPi(geometry::RadFromDeg(deg))};
        };
        DriveGuard guard = Armed(at(from_deg));
        guard.SeePose(NewsAt(10.125, at(from_deg + sign * by_deg)), 10.125);
        return guard;
      };
      INFO(from_deg << " " << sign);
      CHECK(turned(59.9).state() == DriveState::kArmed);
      CheckStopped(turned(61.0), StopReason::kPoseJump,
                   "the pose jumped by 0.000 m and 61 deg within 0.125 s", 10.125);
    }
  }
}

TEST_CASE("A robot that is carried before it is armed jumps as it likes") {
  DriveGuard guard(Options());
  guard.SeePose(NewsAt(10.0), 10.0);
  guard.SeePose(NewsAt(10.125, {3.0, 4.0, 2.0}), 10.125);
  guard.HearRobot(1, 3.0, 10.125);
  guard.HearRobot(2, 3.0, 10.125);
  guard.NoteTime(20.0);
  guard.SeePose(NewsAt(20.0, {1.0, 1.0, 1.0}), 20.0);
  guard.SeePose(NewsAt(19.0, {9.0, 9.0, 0.0}), 20.0);  // older: not taken
  CHECK(guard.state() == DriveState::kDisarmed);
  guard.Arm(20.125);
  CHECK(guard.Allowed() == WheelPower{});
  guard.SeePose(NewsAt(20.125, {1.0, 1.0, 1.0}), 20.125);
  CHECK(guard.state() == DriveState::kArmed);
}

TEST_CASE("A pose that is not finite in any number, or of the future, is not driven by") {
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity(),
                           -std::numeric_limits<double>::infinity()}) {
    for (int member = 0; member < 4; ++member) {
      PoseNews news = NewsAt(10.125);
      trial::PoseMeasurement& pose = news.newest->measured;
      geometry::Pose2& place = pose.world_from_robot;
      (member == 0   ? pose.captured_s
       : member == 1 ? place.x_m
       : member == 2 ? place.y_m
                     : place.yaw_rad) = bad;
      DriveGuard guard = Armed();
      guard.SeePose(news, 10.125);
      INFO(bad << " " << member);
      CheckStopped(guard, StopReason::kPoseNotFinite,
                   "the camera gave a pose that is not finite or lies in the future", 10.125);
    }
  }
  // A clock may be read 0.02 s before the frame is stamped.
  DriveGuard early(Options());
  early.SeePose(NewsAt(0.02), 0.0);
  CHECK(early.state() == DriveState::kDisarmed);
  early.Arm(0.0);
  early.SeePose(NewsAt(0.0201), 0.0);
  CHECK(early.stop()->reason == StopReason::kPoseNotFinite);
}

TEST_CASE("A picture of before the last one stops the drive, and the same one once more does not") {
  DriveGuard guard = Armed();
  guard.SeePose(NewsAt(10.0), 10.0);
  CHECK(guard.state() == DriveState::kArmed);
  guard.SeePose(NewsAt(10.0 - kBeyond), 10.0);
  CheckStopped(guard, StopReason::kTimeBackwards,
               "a picture was taken 0.001 s before the one that came before it", 10.0);
}

TEST_CASE("Whether the robot stopped by itself is told by its count alone") {
  DriveGuard guard = Armed();
  guard.HearRobot(7, 4.0, 10.0);
  guard.HearRobot(8, 4.0, 10.03125);
  CheckStopped(guard, StopReason::kRobotStopped,
               "the robot stopped by itself: it heard no command for too long, or was restarted",
               10.03125);
  OnBothSides("left", "right", [](const Side& side) {
    DriveGuard disarmed(Options());
    disarmed.Command(side.Of<WheelPower>(0.0, -0.25), 10.5);
    CheckStopped(disarmed, StopReason::kNotArmed,
                 "a power was commanded before the drive was armed", 10.5);
  });
}

TEST_CASE("A battery at its limit drives and a lower one does not") {
  DriveGuard guard = Armed();
  guard.HearRobot(7, 3.5, 10.0);
  CHECK(guard.state() == DriveState::kArmed);
  guard.HearRobot(7, 3.25, 10.0);
  CheckStopped(guard, StopReason::kBatteryLow, "the battery is at 3.25 V, below 3.50 V", 10.0);
  CHECK(DriveGuard(GuardOptions{}).state() == DriveState::kDisarmed);
  DriveGuard unwatched(GuardOptions{});
  unwatched.SeePose(NewsAt(10.0), 10.0);
  unwatched.Arm(10.0);
  unwatched.HearRobot(7, 0.0, 10.0);
  CHECK(unwatched.state() == DriveState::kArmed);
}

TEST_CASE("The first stop is the one that is told, and a power after it is not obeyed") {
  DriveGuard guard = Armed();
  guard.Command({0.25, 0.25}, 10.0);
  guard.Stop(StopReason::kOperator, "a key", 10.0);
  guard.Stop(StopReason::kSignal, "SIGINT", 10.125);
  guard.Command({0.5, 0.5}, 10.125);
  PoseNews fault = Looked(10.125);
  fault.fault = "unplugged";
  guard.SeePose(fault, 10.125);
  CheckStopped(guard, StopReason::kOperator, "a key", 10.0);
  DriveGuard before(Options());
  before.SeePose(fault, 10.125);
  CheckStopped(before, StopReason::kCameraGone, "unplugged", 10.125);
  OnBothSides("left", "right", [](const Side& side) {
    DriveGuard refused = Armed();
    refused.Command(side.Of<WheelPower>(-0.875, 0.5), 10.0);
    CheckStopped(refused, StopReason::kPowerRefused,
                 side.IsFirst()
                     ? "the controller asked for the powers -0.875 and 0.5, and the limit is 0.75"
                     : "the controller asked for the powers 0.5 and -0.875, and the limit is 0.75",
                 10.0);
  });
}

}  // namespace
}  // namespace rift::hardware
