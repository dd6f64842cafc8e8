// The guard and the stop of the robot, on both wheels: single rules, and random sequences beside a
// model that says in a few lines what the guard must do.

#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <random>

#include "bench.hpp"
#include "rift/hardware/drive_guard.hpp"
#include "rift/hardware/ping.hpp"
#include "support/mirror.hpp"

namespace rift::hardware {
namespace {

using control::WheelPower;
using test::OnBothSides;
using test::Side;

PoseNews NewsAt(double captured_s, double x_m = 0.0, double yaw_rad = 0.0) {
  PoseNews news;
  news.newest =
      PoseSample{{captured_s, {x_m, 0.0, yaw_rad}, 0.0, 0.0, 0.0}, captured_s, captured_s};
  news.looked_s = captured_s;
  return news;
}

GuardOptions Options() {
  GuardOptions options;
  options.max_power = 0.8;
  options.battery_min_v = 3.6;
  return options;
}

DriveGuard Armed() {
  DriveGuard guard(Options());
  guard.SeePose(NewsAt(10.0), 10.0);
  guard.Arm(10.0);
  return guard;
}

TEST_CASE("A power beyond the limit on either wheel and in either direction stops the drive") {
  OnBothSides("left", "right", [](const Side& side) {
    for (const double power :
         {0.81, -0.81, std::nan(""), std::numeric_limits<double>::infinity()}) {
      DriveGuard guard = Armed();
      guard.Command(side.Of<WheelPower>(power, 0.2), 10.01);
      REQUIRE(guard.stop());
      CHECK(guard.stop()->reason == StopReason::kPowerRefused);
      CHECK(guard.Allowed() == WheelPower{});
    }
    for (const double power : {0.8, -0.8}) {
      DriveGuard guard = Armed();
      guard.Command(side.Of<WheelPower>(power, 0.1), 10.01);
      CHECK(guard.Allowed() == side.Of<WheelPower>(power, 0.1));
    }
    DriveGuard before((Options()));
    before.SeePose(NewsAt(10.0), 10.0);
    before.Command(side.Of<WheelPower>(0.01, 0.0), 10.0);
    REQUIRE(before.stop());
    CHECK(before.stop()->reason == StopReason::kNotArmed);
  });
}

TEST_CASE("A pose older than its limit neither arms nor drives") {
  const double stale_s = Options().pose_stale_s;
  DriveGuard guard(Options());
  CHECK_THROWS_AS(guard.Arm(1.0), std::runtime_error);
  guard.SeePose(NewsAt(10.0), 10.0);
  CHECK_THROWS_WITH(guard.Arm(10.0 + stale_s + 0.001), Catch::Contains("last seen 0.15 s ago"));
  CHECK(guard.state() == DriveState::kDisarmed);
  guard.Arm(10.0 + stale_s - 0.001);
  CHECK(guard.state() == DriveState::kArmed);
  guard.Command({0.1, 0.1}, 10.0 + stale_s + 0.001);
  REQUIRE(guard.stop());
  CHECK(guard.stop()->reason == StopReason::kPoseStale);
}

TEST_CASE("Any change of the robot's stop count stops the drive, its wrap to zero as well") {
  for (const auto& [before, after] : {std::pair{255, 0}, {0, 255}, {3, 4}, {4, 3}, {0, 1}}) {
    DriveGuard guard = Armed();
    guard.HearRobot(static_cast<std::uint8_t>(before), 5.0, 10.01);
    guard.HearRobot(static_cast<std::uint8_t>(before), 5.0, 10.02);
    CHECK(guard.state() == DriveState::kArmed);
    guard.HearRobot(static_cast<std::uint8_t>(after), 5.0, 10.03);
    REQUIRE(guard.stop());
    CHECK(guard.stop()->reason == StopReason::kRobotStopped);
    // Armed anew, the count of before is forgotten: the first answer says where it stands now.
    guard.SeePose(NewsAt(10.05), 10.05);
    guard.Arm(10.05);
    guard.HearRobot(static_cast<std::uint8_t>(before), 5.0, 10.06);
    CHECK(guard.state() == DriveState::kArmed);
  }
}

/// What the guard must do, over a drive in which the robot stands still.
struct Model {
  GuardOptions options = Options();
  DriveState state = DriveState::kDisarmed;
  StopReason reason = StopReason::kFinished;
  WheelPower power;
  double pose_s = -1e9, looked_s = -1e9, commanded_s = 0.0, last_s = -1.0, x_m = 0.0;
  int stops = -1;

  void Stop(StopReason why) {
    power = {};
    if (state != DriveState::kStopped) reason = why;
    state = DriveState::kStopped;
  }
  bool IsArmed() const { return state == DriveState::kArmed; }
  void Look(double now_s) {
    if (IsArmed() && last_s >= 0.0 && (now_s - last_s > options.host_stall_s || now_s < last_s)) {
      Stop(StopReason::kHostStalled);
    }
    last_s = now_s;
  }
  bool Fresh(double now_s) {
    if (now_s - pose_s <= options.pose_stale_s) return true;
    Stop(now_s - looked_s <= options.pose_stale_s ? StopReason::kTagLost : StopReason::kPoseStale);
    return false;
  }
  bool Arm(double now_s) {
    if (now_s - pose_s > options.pose_stale_s) return false;
    state = DriveState::kArmed;
    power = {};
    commanded_s = last_s = now_s;
    stops = -1;
    return true;
  }
  void Pose(double captured_s, double x, double now_s) {
    Look(now_s);
    looked_s = captured_s;
    if (captured_s > now_s + 0.02) return Stop(StopReason::kPoseNotFinite);
    if (IsArmed() && captured_s < pose_s) return Stop(StopReason::kTimeBackwards);
    if (captured_s <= pose_s) return;
    const double room_m = options.jump_m + options.max_speed_mps * (captured_s - pose_s);
    if (IsArmed() && std::abs(x - x_m) > room_m) Stop(StopReason::kPoseJump);
    pose_s = captured_s;
    x_m = x;
  }
  void Command(const WheelPower& wanted, double now_s) {
    Look(now_s);
    commanded_s = now_s;
    for (const double one : {wanted.left, wanted.right}) {
      if (!(one <= options.max_power && one >= -options.max_power)) {
        return Stop(StopReason::kPowerRefused);
      }
    }
    const bool moves = wanted.left != 0.0 || wanted.right != 0.0;
    if (moves && state == DriveState::kDisarmed) return Stop(StopReason::kNotArmed);
    if (moves && !Fresh(now_s)) return;
    power = wanted;
  }
  void Hear(int count, double battery_v) {
    if (IsArmed() && stops >= 0 && stops != count) Stop(StopReason::kRobotStopped);
    stops = count;
    if (IsArmed() && battery_v < options.battery_min_v) Stop(StopReason::kBatteryLow);
  }
  void Tick(double now_s, double lag_s) {
    Look(now_s);
    if (!IsArmed()) return;
    if (lag_s > options.link_lag_s) return Stop(StopReason::kLinkLagging);
    if (power == WheelPower{} || !Fresh(now_s)) return;
    if (now_s - commanded_s > options.control_stale_s) Stop(StopReason::kControlStale);
  }
  WheelPower Allowed() const { return IsArmed() ? power : WheelPower{}; }
};

TEST_CASE("Over random sequences of all that can happen the guard does what its model does") {
  std::map<StopReason, int> met;
  int arms = 0, refused = 0, driving = 0;
  for (std::uint64_t seed = 1; seed <= 400; ++seed) {
    std::mt19937_64 random(seed);
    const auto uniform = [&](double low, double high) {
      return std::uniform_real_distribution<double>(low, high)(random);
    };
    const auto one_in = [&](int n) { return random() % static_cast<unsigned>(n) == 0; };
    DriveGuard guard(Options());
    Model model;
    double now_s = 5.0, x_m = 0.0;
    int stops = static_cast<int>(random() % 256);
    for (int step = 0; step < 300; ++step) {
      now_s += one_in(60) ? 0.3 : one_in(200) ? -0.01 : uniform(0.001, 0.03);
      const auto what = random() % 10;
      if (what < 3) {
        const double captured_s =
            one_in(40) ? now_s + 0.05 : now_s - (one_in(20) ? uniform(0.1, 0.2) : 0.005);
        if (one_in(40)) x_m = uniform(-0.5, 0.5);
        guard.SeePose(NewsAt(captured_s, x_m), now_s);
        model.Pose(captured_s, x_m, now_s);
      } else if (what == 3 && one_in(3)) {
        PoseNews empty;
        empty.looked_s = now_s;
        guard.SeePose(empty, now_s);
        model.Look(now_s);
        model.looked_s = now_s;
      } else if (what < 7) {
        const auto wheel = [&] { return one_in(4) ? 0.0 : one_in(40) ? 0.9 : uniform(-0.8, 0.8); };
        const WheelPower power{wheel(), wheel()};
        guard.Command(power, now_s);
        model.Command(power, now_s);
      } else if (what == 7) {
        if (one_in(15)) stops = (stops + 1) % 256;
        const double battery_v = one_in(60) ? 3.5 : 3.6;
        guard.HearRobot(static_cast<std::uint8_t>(stops), battery_v, now_s);
        model.Hear(stops, battery_v);
      } else if (what == 8) {
        const double lag_s = one_in(30) ? 0.26 : 0.2;
        guard.Tick(now_s, lag_s);
        model.Tick(now_s, lag_s);
      } else if (!model.IsArmed()) {
        const bool is_allowed = model.Arm(now_s);
        if (is_allowed) {
          guard.Arm(now_s);
        } else {
          CHECK_THROWS_AS(guard.Arm(now_s), std::runtime_error);
        }
        ++(is_allowed ? arms : refused);
      } else if (one_in(10)) {
        guard.Stop(StopReason::kOperator, "a key", now_s);
        model.Stop(StopReason::kOperator);
      }
      INFO("seed " << seed << ", step " << step << ", " << what);
      REQUIRE(guard.state() == model.state);
      REQUIRE(guard.Allowed() == model.Allowed());
      driving += !(model.Allowed() == WheelPower{});
      if (model.state == DriveState::kStopped) {
        REQUIRE(guard.stop());
        REQUIRE(guard.stop()->reason == model.reason);
        ++met[model.reason];
      } else {
        REQUIRE_FALSE(guard.stop());
      }
    }
  }
  CHECK(arms > 1000);
  CHECK(refused > 100);
  CHECK(driving > 5000);
  for (const StopReason reason :
       {StopReason::kOperator, StopReason::kPoseStale, StopReason::kTagLost,
        StopReason::kPoseNotFinite, StopReason::kPoseJump, StopReason::kTimeBackwards,
        StopReason::kLinkLagging, StopReason::kControlStale, StopReason::kHostStalled,
        StopReason::kPowerRefused, StopReason::kNotArmed, StopReason::kRobotStopped,
        StopReason::kBatteryLow}) {
    INFO("reason " << static_cast<int>(reason));
    CHECK(met[reason] > 0);
  }
}

/// An armed robot that turns its wheels.
std::unique_ptr<RealRobot> Driving(Bench& bench) {
  auto robot = std::make_unique<RealRobot>(bench, bench, bench,
                                           RealRobotOptions{{}, Protocol::kFramed, false});
  for (int i = 0; i < 30; ++i) robot->Advance(0.02);
  robot->Arm();
  for (int i = 0; i < 10; ++i) {
    robot->Sense();
    robot->Command({0.3, 0.28});
    robot->Advance(0.02);
  }
  return robot;
}

TEST_CASE("A robot that is let go of while it drives is sent zeros, again when they are lost") {
  for (const int lost : {0, 3}) {
    Bench bench;
    std::unique_ptr<RealRobot> robot = Driving(bench);
    REQUIRE(bench.listener->Motors() == MilliPower{300, 280});
    int left = lost;
    bench.lose_command = [&left] { return left-- > 0; };
    const double start_s = bench.Now_s();
    robot.reset();
    CHECK(bench.listener->Motors().IsZero());
    CHECK(bench.listener->Stops() == 0);  // by a command, not by its own watchdog
    CHECK(bench.Now_s() - start_s < 0.35);
  }
  // Where no answer comes back the zeros go on for a while, however many are lost.
  Bench deaf;
  std::unique_ptr<RealRobot> robot = Driving(deaf);
  deaf.from_robot_is_cut = true;
  const double start_s = deaf.Now_s();
  robot.reset();
  CHECK(deaf.listener->Motors().IsZero());
  CHECK(deaf.Now_s() - start_s > 0.25);
}

TEST_CASE("The answer to a zero of before the stop is no acknowledgement of the stop") {
  Bench bench;
  bench.line_delay_s = 0.06;
  RealRobot robot(bench, bench, bench, {{}, Protocol::kFramed, false});
  for (int i = 0; i < 30; ++i) robot.Advance(0.02);  // zeros go out all the time
  bench.to_robot_is_cut = true;                      // those on their way still arrive
  robot.Stop();
  const size_t heard = robot.Record().answered;
  robot.ConfirmStop(0.5);
  CHECK(robot.Record().answered > heard);
  CHECK(robot.Record().stop_acknowledged == false);
  bench.to_robot_is_cut = false;
  robot.ConfirmStop(0.5);
  CHECK(robot.Record().stop_acknowledged == true);
}

TEST_CASE("The quantiles of round trips that vary are four different ones, in order") {
  Bench bench;
  std::mt19937_64 random(4);
  std::uniform_real_distribution<double> delay_s(0.0, 0.008);
  bench.extra_delay_s = [&] { return delay_s(random); };
  PingOptions options;
  options.duration_s = 20.0;
  const PingResult result = Ping(bench, bench, {}, Protocol::kFramed, options);
  CHECK(result.p50_s < result.p95_s);
  CHECK(result.p95_s < result.p99_s);
  CHECK(result.p99_s < result.max_s);
  CHECK(result.OneWay_s() == Approx(0.5 * result.p50_s));
  CHECK(result.jitter_s > 0.001);
  CHECK(result.jitter_s < result.max_s - result.p50_s + 0.008);
}

/// A frame whose checks all hold but the range of its powers.
std::vector<std::uint8_t> FrameOf(std::uint8_t sequence, const MilliPower& power) {
  CommandBytes bytes = Encode(CommandFrame{sequence, {}});
  const auto put = [&bytes](size_t at, int value) {
    bytes[at] = static_cast<std::uint8_t>(value & 0xFF);
    bytes[at + 1] = static_cast<std::uint8_t>((value >> 8) & 0xFF);
  };
  put(2, power.left);
  put(4, power.right);
  put(6, ~power.left);
  put(8, ~power.right);
  bytes.back() = Crc8(Bytes(bytes).first(CommandFrame::kSize - 1));
  return {bytes.begin(), bytes.end()};
}

TEST_CASE("The robot obeys no frame and no line with a power out of range on either wheel") {
  OnBothSides("left", "right", [](const Side& side) {
    for (const int power : {1001, -1001, 32767, -32768}) {
      Listener listener;
      listener.Poll(0, FrameOf(1, {}), {});
      listener.Poll(1, FrameOf(2, side.Of<MilliPower>(power, 100)), {});
      CHECK(listener.Motors().IsZero());
      CHECK_FALSE(DecodeCommand(FrameOf(2, side.Of<MilliPower>(power, 100))));
    }
    for (const int power : {1000, -1000}) {
      Listener listener;
      listener.Poll(0, FrameOf(1, {}), {});
      listener.Poll(1, FrameOf(2, side.Of<MilliPower>(power, 100)), {});
      CHECK(listener.Motors() == side.Of<MilliPower>(power, 100));
    }
    const auto line = [&side](const std::string& word) {
      return side.IsFirst() ? word + " 0.10" : "0.10 " + word;
    };
    CHECK_FALSE(ParsePlainLine(line("1.01")));
    CHECK_FALSE(ParsePlainLine(line("-1.01")));
    CHECK(ParsePlainLine(line("-1.00")) == side.Of<MilliPower>(-1000, 100));
    CHECK_THROWS_AS(MilliOf(side.Of<WheelPower>(1.001, 0.1)), std::invalid_argument);
    CHECK_THROWS_AS(MilliOf(side.Of<WheelPower>(-1.001, 0.1)), std::invalid_argument);
    CHECK_THROWS_AS(PlainLine(side.Of<WheelPower>(1.01, 0.1)), std::invalid_argument);
    CHECK(MilliOf(side.Of<WheelPower>(0.25, -0.5)) == side.Of<MilliPower>(250, -500));
  });
}

}  // namespace
}  // namespace rift::hardware
