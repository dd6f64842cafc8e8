// The turn before a drive: how its pulses grow, what its delays are made of, and what it refuses on
// both sides of each limit.

#include <catch2/catch.hpp>
#include <cmath>
#include <stdexcept>
#include <string>

#include "bench.hpp"
#include "rift/hardware/latency.hpp"
#include "rift/statistics/descriptive.hpp"

namespace rift::hardware {
namespace {

using Powers = std::set<std::pair<int, int>>;

constexpr double kOneWay_s = 0.04;

/// A turn of the robot of a bench, and the record of it.
struct Turned {
  std::optional<LatencyResult> found;
  DriveRecord record;
};

Turned TurnOn(Bench& bench, const HardwareOptions& hardware = {}, double one_way_s = kOneWay_s,
              const Stopper& stopper = nullptr) {
  RealRobot robot(bench, bench, bench, {hardware, Protocol::kFramed, false});
  if (stopper) robot.AddStopper(stopper);
  for (int i = 0; i < 50; ++i) robot.Advance(0.02);
  robot.Arm();
  Turned turned;
  turned.found = MeasureLatency(robot, hardware.odometry, hardware.turn, one_way_s);
  turned.record = robot.Record();
  return turned;
}

/// Nothing stops the turn before it is judged.
HardwareOptions Lenient() {
  HardwareOptions hardware;
  hardware.evidence.pushed_m = 10.0;
  hardware.evidence.pushed_deg = 180.0;
  hardware.evidence.max_latency_s = 2.0;
  return hardware;
}

TEST_CASE(
    "Pulses grow by a quarter up to the most power, seven times, to the left and to the right") {
  Bench bench;
  bench.slip_left = bench.slip_right = 0.0;  // the encoders tell nothing
  HardwareOptions hardware;
  hardware.evidence.pushed_m = 10.0;
  hardware.evidence.pushed_deg = 180.0;
  CHECK_THROWS_WITH(
      TurnOn(bench, hardware),
      Catch::Contains("the wheels turned the robot by 0.0 deg and the picture shows") &&
          Catch::Contains("within 1.2 s"));
  Powers expected{{0, 0}};
  for (const int power : {80, 100, 125, 156, 195, 244, 300}) {
    expected.insert({-power, power});
    expected.insert({power, -power});
  }
  CHECK(bench.written == expected);
}

TEST_CASE("Pulses grow until the robot turns far enough and no further") {
  for (const double enough_deg : {1.0, 12.0, 20.0}) {
    Bench bench;
    HardwareOptions hardware;
    hardware.turn.enough_deg = enough_deg;
    const Turned turned = TurnOn(bench, hardware);
    REQUIRE(turned.found);
    double largest = 0.0;
    for (const auto& [left, right] : bench.written) {
      CHECK(left == -right);
      CHECK(bench.written.count({right, left}) == 1);
      largest = std::max(largest, 0.001 * left);
    }
    INFO(enough_deg << ": " << turned.found->turned_deg << " at " << largest);
    CHECK(turned.found->turned_deg >= enough_deg);
    CHECK(turned.found->seen_deg == Approx(turned.found->turned_deg).margin(1.0));
    // The turn is in proportion to the power: a quarter less would not have been enough.
    if (largest > 0.08) CHECK(turned.found->turned_deg / 1.25 < 1.02 * enough_deg);
    CHECK((largest == Approx(0.08)) == (enough_deg < 5.0));
  }
}

TEST_CASE(
    "The delays of the loop are parts of one sum, and what the link takes is not the robot's") {
  const auto delays = [](double line_delay_s, double one_way_s) {
    Bench bench;
    bench.line_delay_s = line_delay_s;
    const Turned turned = TurnOn(bench, {}, one_way_s);
    const LoopDelay& delay = turned.found.value().delay;
    std::vector<double> host_s;
    for (const PoseStages& pose : turned.record.poses) {
      if (pose.written_s >= 0.0) host_s.push_back(pose.written_s - pose.arrived_s);
    }
    CHECK(*delay.host_s == Approx(statistics::Median(host_s)));
    CHECK(*delay.link_s == one_way_s);
    CHECK(*delay.total_s ==
          Approx(*delay.camera_s + *delay.host_s + *delay.link_s + *delay.robot_s));
    return *delay.robot_s;
  };
  const double own_s = delays(0.02, 0.03);
  // Motors of 0.05 s turn half of their way ln 2 of it late; the line's bytes take 12 ms.
  CHECK(own_s == Approx(0.02 + 0.012 - 0.03 + 0.05).margin(0.02));
  CHECK(delays(0.02, 0.01) == Approx(own_s + 0.02).margin(1e-9));
  CHECK(delays(0.04, 0.03) == Approx(own_s + 0.02).margin(0.008));
  CHECK(delays(0.02, 5.0) == 0.0);
}

/// Why the turn was refused.
std::string Refusal(Bench& bench, const HardwareOptions& hardware) {
  try {
    TurnOn(bench, hardware);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  FAIL("the turn was taken");
  return "";
}

double NumberAfter(const std::string& words, const std::string& text) {
  const size_t at = text.find(words);
  INFO(text);
  REQUIRE(at != std::string::npos);
  return std::stod(text.substr(at + words.size()));
}

TEST_CASE("A picture may be ahead of encoders that are read rarely by their spacing, not by more") {
  for (const auto& [ahead_s, is_taken] : {std::pair{0.01, true}, {0.05, false}}) {
    Bench bench;
    bench.bend = [ahead_s = ahead_s](trial::PoseMeasurement& pose) { pose.captured_s -= ahead_s; };
    if (is_taken) {
      CHECK(*TurnOn(bench).found.value().delay.camera_s == Approx(-ahead_s).margin(0.012));
    } else {
      const std::string why = Refusal(bench, {});
      CHECK(NumberAfter("shows the turn ", why) == Approx(1e3 * ahead_s).margin(12.0));
      CHECK(why.find(" ms before the encoders do") != std::string::npos);
      // Answers come each 0.02 s, or each second time where one is late.
      const double read_ms = NumberAfter("nine in ten are read within ", why);
      CHECK((read_ms >= 18.0 && read_ms <= 42.0));
    }
  }
}

TEST_CASE(
    "A picture that turns less than 0.4 or more than 2.5 times as far as the wheels is refused") {
  for (const auto& [scale, is_taken] :
       {std::pair{0.38, false}, {0.42, true}, {2.4, true}, {2.6, false}}) {
    Bench bench;
    bench.bend = [scale = scale](trial::PoseMeasurement& pose) {
      pose.world_from_robot.yaw_rad *= scale;
    };
    INFO(scale);
    const HardwareOptions hardware = Lenient();
    if (is_taken) {
      const Turned turned = TurnOn(bench, hardware);
      CHECK(turned.found.value().seen_deg == Approx(scale * turned.found->turned_deg).margin(1.0));
    } else {
      const std::string why = Refusal(bench, hardware);
      const double turned_deg = NumberAfter("the wheels turned the robot by ", why);
      CHECK(turned_deg >= hardware.turn.enough_deg);
      CHECK(NumberAfter("the picture shows ", why) == Approx(scale * turned_deg).margin(1.0));
    }
  }
}

TEST_CASE("A person who stops the turn gets no complaint, whatever the picture shows") {
  for (const auto& [reason, is_asked] : {std::pair{StopReason::kOperator, true},
                                         {StopReason::kSignal, true},
                                         {StopReason::kCameraGone, false}}) {
    Bench bench;
    bench.bend = [](trial::PoseMeasurement& pose) { pose.world_from_robot.yaw_rad *= -1.0; };
    const double begun_s = bench.Now_s();  // after 1.3 s both pulses are over
    const Stopper stopper = [&, reason = reason]() {
      return bench.Now_s() < begun_s + 1.5 ? std::nullopt
                                           : std::optional(std::pair(reason, std::string("stop")));
    };
    if (is_asked) {
      const Turned turned = TurnOn(bench, Lenient(), kOneWay_s, stopper);
      CHECK_FALSE(turned.found);
      CHECK(turned.record.stop->reason == reason);
    } else {
      CHECK_THROWS_WITH(TurnOn(bench, Lenient(), kOneWay_s, stopper),
                        Catch::Contains("the picture is mirrored"));
    }
    CHECK(bench.listener->Motors().IsZero());
  }
}

TEST_CASE("A turn takes its pulses, half a second and a little more after each, and 0.7 s") {
  Bench bench;
  HardwareOptions hardware;
  hardware.turn.enough_deg = 1.0;
  const auto turn_s = [&] {
    RealRobot robot(bench, bench, bench, {hardware, Protocol::kFramed, false});
    for (int i = 0; i < 50; ++i) robot.Advance(0.02);
    robot.Arm();
    const double begun_s = bench.Now_s();
    try {
      MeasureLatency(robot, hardware.odometry, hardware.turn, kOneWay_s);
    } catch (const std::runtime_error&) {  // it is not seen to turn
    }
    return bench.Now_s() - begun_s;
  };
  // The second rest is longer by 0.05 s.
  CHECK(turn_s() == Approx(0.02 + 2 * (0.06 + 0.5) + 0.05 + 0.7).margin(0.02));
  bench.slip_left = bench.slip_right = 0.0;
  hardware = Lenient();
  // Twice 0.05, 0.15, 0.05 and 0.2 s, and once 0.05 s.
  CHECK(turn_s() == Approx(0.02 + 14 * (0.06 + 0.5) + 0.95 + 0.7).margin(0.05));
}

/// A bench's line that notes when each power other than zero was begun to be sent.
class Noted : public ByteLine {
 public:
  explicit Noted(Bench& bench) : bench_(bench) {}
  bool Write(Bytes bytes) override {
    const auto frame = DecodeCommand(bytes);
    if (frame && !frame->power.IsZero() && last_.IsZero()) begun_s.push_back(bench_.Now_s());
    if (frame) last_ = frame->power;
    return bench_.Write(bytes);
  }
  std::vector<std::uint8_t> Read() override { return bench_.Read(); }
  size_t Unsent() override { return bench_.Unsent(); }

  std::vector<double> begun_s;

 private:
  Bench& bench_;
  MilliPower last_;
};

TEST_CASE("No pair of pulses is like the one before: each rest is longer by its own time") {
  Bench bench;
  bench.slip_left = bench.slip_right = 0.0;  // it never turns far enough
  Noted line(bench);
  HardwareOptions hardware = Lenient();
  hardware.line.baud = 1'000'000;  // no command waits for the one before
  RealRobot robot(line, bench, bench, {hardware, Protocol::kFramed, false});
  for (int i = 0; i < 50; ++i) robot.Advance(0.02);
  robot.Arm();
  CHECK_THROWS(MeasureLatency(robot, hardware.odometry, hardware.turn, kOneWay_s));
  REQUIRE(line.begun_s.size() == 14);
  const std::vector<double> more_s{0.0, 0.05, 0.15, 0.0, 0.05, 0.2};
  for (size_t i = 1; i < line.begun_s.size(); ++i) {
    INFO("after pulse " << i);
    CHECK(line.begun_s[i] - line.begun_s[i - 1] ==
          Approx(0.06 + 0.5 + more_s[(i - 1) % 6]).margin(0.0025));
  }
}

TEST_CASE("A picture may be ahead of encoders that are read often by two hundredths of a second") {
  const auto turn_on = [](double ahead_s) {
    Bench bench;
    bench.bend = [=](trial::PoseMeasurement& pose) { pose.captured_s -= ahead_s; };
    HardwareOptions hardware = Lenient();
    hardware.line.baud = 1'000'000;
    hardware.line.heartbeat_s = 0.017;  // and between two of them one for each picture
    return TurnOn(bench, hardware);
  };
  const double own_s = *turn_on(0.0).found.value().delay.camera_s;
  CHECK(*turn_on(own_s + 0.0192).found.value().delay.camera_s == Approx(-0.0192).margin(0.0005));
  CHECK_THROWS_WITH(turn_on(own_s + 0.021),
                    Catch::StartsWith("the picture shows the turn 21 ms before the encoders do"));
}

TEST_CASE("How far apart encoders are read is told by nine in ten, not by the usual two") {
  Bench bench;
  int commands = 0;
  bench.lose_command = [&commands] { return ++commands % 4 == 0; };
  bench.bend = [](trial::PoseMeasurement& pose) { pose.captured_s -= 0.095; };
  HardwareOptions hardware = Lenient();
  hardware.guard.pose_stale_s = hardware.guard.link_lag_s = 1.0;
  const std::string why = Refusal(bench, hardware);
  // Two in four are read some 0.035 s apart, one twice as far.
  CHECK(NumberAfter("nine in ten are read within ", why) > 55.0);
}

TEST_CASE("Pulses of a few degrees tell how long the robot takes as well") {
  Bench bench;
  HardwareOptions hardware;
  hardware.turn.power = 0.04;
  hardware.turn.enough_deg = 1.0;
  const Turned turned = TurnOn(bench, hardware);
  REQUIRE(turned.found);
  CHECK(turned.found->turned_deg > 1.0);
  CHECK(turned.found->turned_deg < 5.7);  // a tenth of a radian
  REQUIRE(turned.found->delay.robot_s);
  // The line and its bytes, less what the link is told to take, and the motors.
  CHECK(*turned.found->delay.robot_s == Approx(0.02 + 0.012 - kOneWay_s + 0.05).margin(0.025));
}

TEST_CASE("A picture that is far ahead of the wheels is told to be by all that is looked for") {
  Bench bench;
  bench.bend = [](trial::PoseMeasurement& pose) { pose.captured_s -= 0.15; };
  HardwareOptions hardware = Lenient();
  hardware.guard.pose_stale_s = 1.0;
  CHECK(NumberAfter("the picture shows the turn ", Refusal(bench, hardware)) == 100.0);
}

/// A slow turn to one side and back, `count` times read.
std::vector<Angle> Turn(size_t count, double every_s, double rad) {
  std::vector<Angle> angles;
  for (size_t i = 0; i < count; ++i) {
    angles.push_back({every_s * static_cast<double>(i), i % 2 == 0 ? 0.0 : rad});
  }
  return angles;
}

TEST_CASE("Angles that are few or hardly turn have no lag, at the limit of either") {
  CHECK(EstimateLag(Turn(8, 0.1, 0.2), Turn(20, 0.1, 0.2), -0.1, 0.1));
  CHECK_FALSE(EstimateLag(Turn(7, 0.1, 0.2), Turn(20, 0.1, 0.2), -0.1, 0.1));
  CHECK(EstimateLag(Turn(20, 0.1, 0.0011), Turn(20, 0.1, 0.0011), -0.1, 0.1));
  CHECK_FALSE(EstimateLag(Turn(20, 0.1, 0.0009), Turn(20, 0.1, 0.2), -0.1, 0.1));
  CHECK_FALSE(EstimateLag(Turn(20, 0.1, 0.2), Turn(20, 0.1, 0.0009), -0.1, 0.1));
  CHECK(AreTimed(Turn(8, 0.099, 0.2)));
  CHECK_FALSE(AreTimed(Turn(8, 0.101, 0.2)));
  CHECK_FALSE(AreTimed(Turn(7, 0.01, 0.2)));
  CHECK_FALSE(AreTimed({}));
}

TEST_CASE("A lag between the steps of the search is found to a tenth of them") {
  std::vector<Angle> leader;
  for (int i = 0; i < 400; ++i) leader.push_back({0.01 * i, std::sin(0.05 * i)});
  // Steps of 5 ms.
  for (const double lag_s : {0.0825, 0.0712, 0.0788, -0.0333}) {
    std::vector<Angle> follower;
    for (int i = 0; i < 300; ++i) {
      const double t_s = 0.5 + 0.01 * i;
      follower.push_back({t_s, std::sin(5.0 * (t_s - lag_s))});
    }
    const std::optional<Lag> found = EstimateLag(follower, leader, -0.1, 0.2);
    REQUIRE(found);
    CHECK(found->lag_s == Approx(lag_s).margin(0.0005));
  }
}

TEST_CASE("What is left at the best lag is the root mean square of the noise") {
  std::vector<Angle> leader, follower;
  for (int i = 0; i < 400; ++i) {
    leader.push_back({0.01 * i, std::sin(0.05 * i)});
    const double noise_rad = i % 2 == 0 ? 0.02 : -0.02;
    follower.push_back({0.01 * i + 0.08, 0.7 * std::sin(0.05 * i) + 1.0 + noise_rad});
  }
  const std::optional<Lag> found = EstimateLag(follower, leader, 0.0, 0.2);
  REQUIRE(found);
  CHECK(found->lag_s == Approx(0.08).margin(0.001));
  CHECK(found->scale == Approx(0.7).margin(0.003));
  CHECK(found->residual_rad == Approx(0.02).margin(0.0005));
}

}  // namespace
}  // namespace rift::hardware
