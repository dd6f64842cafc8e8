#include "twin/twin_robot.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <functional>

#include "rift/twin/options.hpp"
#include "rift/twin/twin.hpp"
#include "twin/pacing.hpp"
#include "twin/true_path.hpp"

namespace rift::twin {
namespace {

constexpr double kPower = 0.2;

simulation::SimulationOptions Options() {
  simulation::SimulationOptions options = AsTwin({}, {});
  options.link.delay_s = 0.02;
  return options;
}

std::vector<std::uint8_t> Frame(std::uint8_t sequence, double power) {
  const hardware::CommandBytes bytes =
      hardware::Encode({sequence, hardware::MilliOf({power, power})});
  return {bytes.begin(), bytes.end()};
}

std::vector<std::uint8_t> Text(const std::string& text) { return {text.begin(), text.end()}; }

/// A host that says something every 40 ms until `silent_s`; returns when the motors were last on.
double LastPowered_s(TwinRobot& robot, double silent_s, double until_s,
                     const std::function<std::vector<std::uint8_t>(int)>& say) {
  double powered_s = -1.0;
  const auto witness = [&](const simulation::TruePose& pose, const control::WheelPower& power) {
    if (power.left != 0.0 || power.right != 0.0) powered_s = pose.t_s;
  };
  for (int i = 0; 0.04 * i < until_s; ++i) {
    if (0.04 * i <= silent_s) robot.Receive(0.04 * i, say(i));
    robot.Advance(0.04 * (i + 1), witness);
  }
  return powered_s;
}

std::vector<std::uint8_t> FramedHost(int i) {
  return Frame(static_cast<std::uint8_t>(i + 1), i == 0 ? 0.0 : kPower);
}

TEST_CASE("Frames move the twin and its own watchdog stops it after the last one") {
  TwinRobot robot(Options(), 5.0, {}, 1);
  const double last_s = LastPowered_s(robot, 0.8, 2.0, FramedHost);
  // Delay, 11 bytes at 9600 baud, 300 ms.
  CHECK(last_s == Approx(0.8 + 0.02 + 11 * 10.0 / 9600 + 0.3).margin(0.006));
  CHECK(robot.Truth().x_m > 0.1);
  CHECK(robot.Listener().Stops() == 1);
}

TEST_CASE("The authors' text moves the twin as well") {
  TwinRobot robot(Options(), 5.0, {}, 1);
  const double last_s = LastPowered_s(robot, 0.8, 2.0, [](int) { return Text("0.20 0.20\n"); });
  CHECK(last_s > 1.0);
  CHECK(robot.Truth().x_m > 0.1);
}

TEST_CASE("A frame without a zero before it does not move the twin") {
  TwinRobot robot(Options(), 5.0, {}, 1);
  const auto say = [](int i) { return Frame(static_cast<std::uint8_t>(i + 1), kPower); };
  CHECK(LastPowered_s(robot, 0.8, 1.0, say) < 0.0);
  CHECK(robot.Truth().x_m == Approx(0.0).margin(1e-4));
}

TEST_CASE("The twin's radio takes no more while 4 KiB are on their way") {
  TwinRobot robot(Options(), 5.0, {}, 1);
  robot.Receive(0.0, std::vector<std::uint8_t>(4095, 'x'));
  CHECK(robot.CanReceive());
  robot.Receive(0.0, Text("x"));
  CHECK_FALSE(robot.CanReceive());
  robot.Advance(0.1, [](const auto&, const auto&) {});  // some 77 of them have arrived
  CHECK(robot.CanReceive());
}

TEST_CASE("The twin answers with its encoders and its battery") {
  TwinRobot robot(Options(), 4.9, {}, 1);
  LastPowered_s(robot, 0.8, 2.0, FramedHost);
  const std::vector<std::uint8_t> said = robot.Transmit(2.0);
  REQUIRE(said.size() >= hardware::Answer::kSize);
  const auto last = hardware::DecodeAnswer(hardware::Bytes(said).last(hardware::Answer::kSize));
  REQUIRE(last);
  CHECK(last->battery_mv == 4900);
  CHECK(last->left > 100);
}

TEST_CASE("The same bytes at the same times move the twin the same way") {
  simulation::SimulationOptions options = Options();
  options.link.byte_loss = 0.02;
  TwinRobot one(options, 5.0, {}, 7), again(options, 5.0, {}, 7), other(options, 5.0, {}, 8);
  for (TwinRobot* robot : {&one, &again, &other}) LastPowered_s(*robot, 3.0, 3.0, FramedHost);
  CHECK(one.Truth().x_m == again.Truth().x_m);
  CHECK(one.Listener().Rejected() == again.Listener().Rejected());
  CHECK(one.Listener().Rejected() > 0);
  CHECK(one.Truth().x_m != other.Truth().x_m);
}

TEST_CASE("A byte comes after delay and line time and none overtakes another") {
  simulation::LinkOptions options{.delay_s = 0.1, .baud = 1000.0};
  ByteChannel channel(options, 1);
  channel.Put(0.0, Text("ab"));
  channel.Put(0.001, Text("c"));
  CHECK(channel.Take(0.109).empty());
  CHECK(channel.Take(0.1101) == Text("a"));
  CHECK(channel.Take(0.1301) == Text("bc"));
}

TEST_CASE("Lost shares of bytes and of lines are those asked for") {
  constexpr int kLines = 5000;
  for (const auto& [line_loss, byte_loss] : {std::pair{0.1, 0.0}, {0.0, 0.1}, {0.1, 0.1}}) {
    simulation::LinkOptions options{.delay_s = 0.0, .baud = 0.0};
    options.line_loss = line_loss;
    options.byte_loss = byte_loss;
    ByteChannel channel(options, 3);
    for (int i = 0; i < kLines; ++i) channel.Put(i, Text("0123456789"));
    const double share = static_cast<double>(channel.Take(kLines).size()) / (10.0 * kLines);
    CHECK(share == Approx((1.0 - line_loss) * (1.0 - byte_loss)).margin(0.02));
  }
}

TEST_CASE("A process that stood still does not hurry afterwards") {
  Pacer pacer(100.0);
  CHECK(pacer.Simulated_s(100.2) == Approx(0.2));
  CHECK(pacer.Simulated_s(105.2) == Approx(0.2 + Pacer::kMostBehind_s));
  CHECK(pacer.Skipped_s() == Approx(5.0 - Pacer::kMostBehind_s));
  CHECK(pacer.ClockOf_s(pacer.Simulated_s(105.3)) == Approx(105.3));
}

TEST_CASE("A trial is over when the robot drove and was off for long enough") {
  TrialEnd end(2.0);
  end.Observe(1.0, {});
  CHECK_FALSE(end.IsOver(60.0));
  end.Observe(60.0, {0.0, 0.1});
  end.Observe(60.1, {});
  CHECK_FALSE(end.IsOver(61.9));
  CHECK(end.IsOver(62.0));
}

TEST_CASE("The true path is known between two steps with its velocity") {
  TruePath path({.t_s = 0.0, .x_m = 1.0});
  path.Add({.t_s = 0.1, .x_m = 1.02, .yaw_rad = 0.2});
  path.Add({.t_s = 0.2, .x_m = 1.04, .yaw_rad = 0.2});
  const TruePath::Moment moment = path.At(0.05);
  CHECK(moment.pose.x_m == Approx(1.01));
  CHECK(moment.pose.yaw_rad == Approx(0.1));
  CHECK(moment.vx_mps == Approx(0.2));
  CHECK(moment.yaw_rate_radps == Approx(2.0));
  CHECK(path.Path().poses.size() == 3);
}

TEST_CASE("The tag sits where the mocap has it and moves with the robot") {
  TruePath::Moment moment;
  moment.pose.yaw_rad = M_PI / 2;
  moment.yaw_rate_radps = 2.0;
  const vision::RobotMotion tag = TagOf(moment, {.tag_ahead_m = -0.03, .tag_above_m = 0.02});
  CHECK((tag.world_from_tag.translation() - Eigen::Vector3d(0.0, -0.03, 0.02)).norm() < 1e-12);
  CHECK((tag.velocity_mps - Eigen::Vector3d(0.06, 0.0, 0.0)).norm() < 1e-12);
}

TEST_CASE("What the twin saves for simulate keeps up with the line") {
  // A line of two decimals takes 10 ms at 9600 baud, of all decimals up to 40, longer than a step.
  const simulation::SimulationOptions options = AsTwin({}, {});
  CHECK(options.link.two_decimals);
  CHECK(options.link.poll_s == 0.0);
  CHECK(options.link.watchdog_s == 0.3);
  CHECK(options.mocap.rate_hz == 30.0);
}

TEST_CASE("The camera hangs over the middle of the task and refuses one it cannot see") {
  const std::vector<control::Waypoint> task{{"a", -0.2, 0.1}, {"b", 0.4, 0.3}};
  const vision::CameraModel camera = OverheadCamera(task, {});
  REQUIRE(camera.world);
  CHECK((camera.world->world_from_camera.translation() - Eigen::Vector3d(0.1, 0.2, 0.87)).norm() <
        1e-12);
  const std::vector<control::Waypoint> far{{"a", 0.0, 0.0}, {"b", 3.0, 0.0}};
  CHECK_THROWS_WITH(OverheadCamera(far, {}), Catch::Contains("1.82 m"));
}

}  // namespace
}  // namespace rift::twin
