#include <catch2/catch.hpp>
#include <cmath>

#include "rift/hardware/serial_port.hpp"
#include "rift/statistics/random.hpp"
#include "rift/twin/options.hpp"
#include "rift/twin/twin.hpp"
#include "support/mirror.hpp"
#include "twin/pacing.hpp"
#include "twin/pseudo_terminal.hpp"
#include "twin/stream_camera.hpp"
#include "twin/true_path.hpp"
#include "twin/twin_robot.hpp"

namespace rift::twin {
namespace {

TEST_CASE("A simulation as the twin runs it has its line, its camera and its encoders") {
  simulation::SimulationOptions options;
  options.link.late_share = 0.25;
  options.mocap.frame_jitter_s = 0.01;
  options.mocap.host_period_s = 0.05;
  options.mocap.tag_above_m = 0.0;
  options.mocap.ambiguity.share = 0.5;
  options.encoder.reported = false;
  TwinOptions twin;
  twin.fps = 25.0;
  twin.camera.body_height_m = 0.04;
  const simulation::SimulationOptions as = AsTwin(options, twin);
  CHECK(as.link.uart_bytes == 512);
  CHECK(as.link.poll_s == 0.0);
  CHECK(as.link.watchdog_s == 0.3);
  CHECK(as.link.late_share == 0.0);
  CHECK(as.mocap.rate_hz == 25.0);
  CHECK(as.mocap.frame_jitter_s == 0.0);
  CHECK_FALSE(as.mocap.host_period_s);
  CHECK(as.mocap.ambiguity.share == 0.0);
  // Without its simulated host there is the real one, which finds the tag in a time of its own.
  CHECK(as.mocap.processing_s == options.mocap.processing_s + twin.host_share_s);
  options.mocap.host_period_s.reset();
  CHECK(AsTwin(options, twin).mocap.processing_s == options.mocap.processing_s);
  // On the body, whose height is from the floor; a tag's is from the axle.
  CHECK(as.mocap.tag_above_m == Approx(0.04 - 0.016));
  CHECK(as.encoder.reported);
  options.mocap.tag_above_m = 0.02;
  CHECK(AsTwin(options, twin).mocap.tag_above_m == 0.02);
}

TEST_CASE("The camera sees the task with ten centimetres to spare on every side") {
  test::OnBothSides("x", "y", [](const test::Side& side) {
    // 1 m along this side: 0.6 m from the middle, at a focal length of 1092 px.
    const double needed_m = 0.6 * 1092.0 / (side.IsFirst() ? 960.0 : 540.0);
    const std::vector<control::Waypoint> task{
        {"a", 0.1, -0.2}, {"b", side.IsFirst() ? 1.1 : 0.1, side.IsFirst() ? -0.2 : 0.8}};
    TwinOptions options;
    options.camera_height_m = needed_m + 1e-6;
    const vision::CameraModel camera = OverheadCamera(task, options);
    CHECK(camera.width_px == 1920);
    CHECK(camera.height_px == 1080);
    CHECK(camera.world->world_from_camera.translation().z() == options.camera_height_m);
    const Eigen::Vector3d middle(side.IsFirst() ? 0.6 : 0.1, side.IsFirst() ? -0.2 : 0.3, 0.0);
    const Eigen::Vector3d seen = camera.world->world_from_camera.inverse() * middle;
    CHECK(seen.head<2>().norm() < 1e-9);
    CHECK(seen.z() == Approx(options.camera_height_m));
    options.camera_height_m = needed_m - 1e-3;
    CHECK_THROWS_WITH(OverheadCamera(task, options),
                      Catch::Contains(side.IsFirst() ? "at 0.69 m" : "at 1.22 m"));
  });
}

TEST_CASE("The twin's camera has the lens of about the authors' webcam, and says so in its file") {
  const std::vector<control::Waypoint> task{{"a", 0.0, 0.0}, {"b", 0.3, 0.1}};
  const vision::CameraModel camera = OverheadCamera(task, {});
  CHECK(camera.name == "twin");
  Eigen::Matrix3d k;
  k << 1092.0, 0.0, 958.0, 0.0, 1092.0, 543.0, 0.0, 0.0, 1.0;
  CHECK(camera.k == k);
  CHECK(std::vector<double>(camera.distortion.begin(), camera.distortion.end()) ==
        std::vector<double>{0.06, -0.09, 0.001, -0.001, 0.02});
  REQUIRE(camera.world);
  CHECK(camera.world->origin == "as built");
  // What lies ahead in x is to the right of the picture, and in y above its middle.
  const Eigen::Matrix3d turn = camera.world->world_from_camera.linear();
  CHECK((turn.col(0) - Eigen::Vector3d::UnitX()).norm() < 1e-12);
  CHECK((turn.col(1) + Eigen::Vector3d::UnitY()).norm() < 1e-12);
  CHECK((turn.col(2) + Eigen::Vector3d::UnitZ()).norm() < 1e-12);
  TwinOptions low;
  low.camera_height_m = 0.25;
  // 0.3 m and 0.1 m with 0.1 m around: 0.25 m of 960 px, and 0.15 m of 540 px, at 1092 px.
  CHECK_THROWS_WITH(OverheadCamera(task, low),
                    "twin.camera_height_m is 0.25, but to see the whole path and 0.1 m around them "
                    "the camera must hang at 0.31 m");
}

TEST_CASE("A picture is held back from the middle of its exposure for what the host does not do") {
  simulation::MocapOptions mocap;
  mocap.exposure_s = 0.01;
  mocap.processing_s = 0.04;
  TwinOptions options;
  options.host_share_s = 0.015;
  CHECK(HoldBack_s(mocap, options) == Approx(0.005 + 0.025));
  options.host_share_s = 0.05;
  CHECK(HoldBack_s(mocap, options) == Approx(0.005));
}

TEST_CASE("The pacer takes a quarter of a second as it comes and skips what is beyond") {
  Pacer pacer(100.0);
  CHECK(pacer.Simulated_s(100.25) == Approx(0.25));
  CHECK(pacer.Skipped_s() == 0.0);
  CHECK(pacer.Simulated_s(101.25) == Approx(0.5));
  CHECK(pacer.Simulated_s(102.25) == Approx(0.75));
  CHECK(pacer.Skipped_s() == Approx(1.5));
  CHECK(pacer.ClockOf_s(0.75) == Approx(102.25));
}

TEST_CASE("Either wheel alone is a drive, and none before the first power is an end") {
  for (const control::WheelPower& power :
       {control::WheelPower{0.1, 0.0}, control::WheelPower{0.0, -0.1}}) {
    TrialEnd end(2.0);
    CHECK_FALSE(end.HasDriven());
    end.Observe(1.0, power);
    CHECK(end.HasDriven());
    CHECK_FALSE(end.IsOver(2.99));
    CHECK(end.IsOver(3.0));
  }
}

TEST_CASE("A path has a row for each hundredth of a second in motion and each second at rest") {
  const auto rows = [](double period_s, int count, const auto& pose_at) {
    TruePath path(simulation::TruePose{});
    for (int i = 1; i <= count; ++i) {
      simulation::TruePose pose = pose_at(i);
      pose.t_s = i * period_s;
      path.Add(pose);
    }
    return path.Path().poses.size() - 1;
  };
  using Pose = simulation::TruePose;
  const double step_s = 1.0 / 512.0;
  CHECK(rows(step_s, 512, [](int i) { return Pose{.x_m = 1e-3 * i}; }) == 512 / 6);
  CHECK(rows(step_s, 512, [](int i) { return Pose{.y_m = -1e-3 * i}; }) == 512 / 6);
  CHECK(rows(step_s, 512, [](int i) { return Pose{.yaw_rad = -1e-3 * i}; }) == 512 / 6);
  CHECK(rows(step_s, 3 * 512, [](int) { return Pose{}; }) == 3);
  CHECK(rows(0.25, 8, [](int) { return Pose{.x_m = 0.9e-5}; }) == 2);
  CHECK(rows(0.25, 8, [](int) { return Pose{.x_m = 1.1e-5}; }) == 1 + 1);
  CHECK(rows(0.25, 3, [](int) { return Pose{.yaw_rad = 0.9e-4}; }) == 0);
  CHECK(rows(0.25, 3, [](int) { return Pose{.yaw_rad = 1.1e-4}; }) == 1);
}

TEST_CASE("Every axis of the true path is known between its steps, and turns the short way") {
  TruePath path({.t_s = 1.0,
                 .x_m = 1.0,
                 .y_m = -2.0,
                 .z_m = 0.5,
                 .roll_rad = 0.1,
                 .pitch_rad = -0.2,
                 .yaw_rad = 3.1});
  path.Add({.t_s = 1.5,
            .x_m = 1.1,
            .y_m = -2.2,
            .z_m = 0.6,
            .roll_rad = 0.2,
            .pitch_rad = -0.4,
            .yaw_rad = -3.1});
  const TruePath::Moment moment = path.At(1.125);
  CHECK(moment.pose.t_s == 1.125);
  CHECK(moment.pose.x_m == Approx(1.025));
  CHECK(moment.pose.y_m == Approx(-2.05));
  CHECK(moment.pose.z_m == Approx(0.525));
  CHECK(moment.pose.roll_rad == Approx(0.125));
  CHECK(moment.pose.pitch_rad == Approx(-0.25));
  const double turn_rad = 2.0 * M_PI - 6.2;
  CHECK(moment.pose.yaw_rad == Approx(3.1 + 0.25 * turn_rad));
  CHECK(moment.vx_mps == Approx(0.2));
  CHECK(moment.vy_mps == Approx(-0.4));
  CHECK(moment.vz_mps == Approx(0.2));
  CHECK(moment.yaw_rate_radps == Approx(2.0 * turn_rad));
  CHECK(path.At(0.0).pose.x_m == 1.0);          // before its begin
  CHECK(path.At(9.0).pose.x_m == Approx(1.1));  // and after its end
  CHECK(path.Newest_s() == 1.5);
  const auto row = path.Path().poses.back();
  CHECK(row.roll_rad == Approx(0.2));
  CHECK(row.pitch_rad == Approx(-0.4));
  CHECK(row.z_m == Approx(0.6));
}

TEST_CASE("Three seconds of the true path are remembered step by step") {
  TruePath path(simulation::TruePose{});
  for (int i = 1; i <= 50; ++i) path.Add({.t_s = 0.1 * i, .x_m = 0.01 * i * i});
  CHECK(path.At(2.05).pose.x_m == Approx(0.5 * (4.0 + 4.41)));
  CHECK(path.At(1.0).pose.x_m > 1.5);  // older than that: the oldest that is known
}

TEST_CASE("A leaning tag is carried by roll, pitch and yaw as the robot has them") {
  TruePath::Moment moment;
  moment.pose = {.x_m = 1.0, .y_m = 2.0, .z_m = 0.1};
  moment.vx_mps = 0.1;
  moment.vy_mps = 0.2;
  moment.vz_mps = 0.3;
  const simulation::MocapOptions mocap{.tag_ahead_m = 0.05, .tag_above_m = 0.02};
  const auto place = [&] { return TagOf(moment, mocap).world_from_tag.translation().eval(); };
  const auto is = [](const Eigen::Vector3d& a, double x, double y, double z) {
    return (a - Eigen::Vector3d(x, y, z)).norm() < 1e-9;
  };
  CHECK(is(place(), 1.05, 2.0, 0.12));
  CHECK(is(TagOf(moment, mocap).velocity_mps, 0.1, 0.2, 0.3));
  moment.pose.roll_rad = M_PI / 2;  // the tag to the right of the robot
  CHECK(is(place(), 1.05, 1.98, 0.1));
  moment.pose.roll_rad = 0.0;
  moment.pose.pitch_rad = M_PI / 2;  // its front down
  CHECK(is(place(), 1.02, 2.0, 0.05));
  moment.pose.yaw_rad = M_PI / 2;
  CHECK(is(place(), 1.0, 2.02, 0.05));
  moment.pose.roll_rad = 0.3;
  const Eigen::Matrix3d turn = TagOf(moment, mocap).world_from_tag.linear();
  CHECK((turn.col(0) - Eigen::Vector3d(0.0, 0.0, -1.0)).norm() < 1e-9);
  moment.yaw_rate_radps = 2.0;
  CHECK(TagOf(moment, mocap).yaw_rate_radps == 2.0);
}

TEST_CASE("A faster left wheel turns the twin right and has the more counts, and the right left") {
  test::OnBothSides("left", "right", [](const test::Side& side) {
    TwinRobot robot(AsTwin({}, {}), 5.0, {}, 1);
    for (int i = 0; i < 20; ++i) {
      const auto power = i == 0 ? hardware::MilliOf({0.0, 0.0})
                                : hardware::MilliOf(side.Of<control::WheelPower>(0.25, 0.15));
      const hardware::CommandBytes bytes =
          hardware::Encode({static_cast<std::uint8_t>(i + 1), power});
      robot.Receive(0.04 * i, bytes);
      robot.Advance(0.04 * (i + 1), [&](const auto&, const control::WheelPower& commanded) {
        if (i < 5) return;
        CHECK(commanded.left == Approx(side.IsFirst() ? 0.25 : 0.15));
        CHECK(commanded.right == Approx(side.IsFirst() ? 0.15 : 0.25));
      });
    }
    const std::vector<std::uint8_t> said = robot.Transmit(0.8);
    REQUIRE(said.size() >= hardware::Answer::kSize);
    const auto last = hardware::DecodeAnswer(hardware::Bytes(said).last(hardware::Answer::kSize));
    REQUIRE(last);
    CHECK((last->left > last->right) == side.IsFirst());
    CHECK((robot.Truth().yaw_rad < -0.1) == side.IsFirst());
    CHECK((robot.Truth().yaw_rad > 0.1) != side.IsFirst());
  });
}

TEST_CASE("The twin shows each step of its physics once, with the power at the motors then") {
  TwinRobot robot(AsTwin({}, {}), 5.0, {}, 1);
  std::vector<double> times_s;
  const auto see = [&](const simulation::TruePose& pose, const control::WheelPower& power) {
    times_s.push_back(pose.t_s);
    CHECK(power == control::WheelPower{});
  };
  robot.Advance(0.1, see);
  CHECK(robot.Now_s() == Approx(0.1).margin(1e-12));
  robot.Advance(0.1009, see);  // less than a turn of its loop
  CHECK(robot.Now_s() == Approx(0.1).margin(1e-12));
  robot.Advance(0.2, see);
  CHECK(robot.Now_s() == Approx(0.2).margin(1e-12));
  REQUIRE(times_s.size() == 50);  // of 4 ms
  for (size_t i = 0; i < times_s.size(); ++i) {
    CHECK(times_s[i] == Approx(0.004 * static_cast<double>(i + 1)));
  }
  CHECK(robot.Transmit(0.2).empty());  // it was told nothing
}

TEST_CASE("What the twin is told and what it says both take the way of its radio") {
  simulation::SimulationOptions options = AsTwin({}, {});
  options.link.delay_s = 0.05;
  options.link.baud = 10'000.0;  // a millisecond a byte
  TwinRobot robot(options, 4.321, {}, 1);
  const hardware::CommandBytes zero = hardware::Encode(hardware::CommandFrame{5, {}});
  robot.Receive(0.1, zero);
  robot.Advance(0.5, [](const auto&, const auto&) {});
  // 0.05 s and 11 bytes there, a turn of the loop, 0.05 s and 15 bytes back.
  CHECK(robot.Transmit(0.1 + 0.05 + 0.011 + 0.05 + 0.014 - 0.0005).size() < 15);
  const auto rest = robot.Transmit(0.1 + 0.05 + 0.011 + 0.05 + 0.015 + 0.0025);
  CHECK_FALSE(rest.empty());
  CHECK(robot.Transmit(1.0).empty());
}

TEST_CASE("What the twin's radio loses is drawn for each way by itself, of its seed") {
  simulation::SimulationOptions options = AsTwin({}, {});
  options.link.line_loss = 0.4;
  for (const std::uint64_t seed : {1, 2}) {
    TwinRobot robot(options, 5.0, {}, seed);
    ByteChannel there(options.link, statistics::SeedOfStream(seed, 100)),
        back(options.link, statistics::SeedOfStream(seed, 101));
    std::vector<int> heard, expected;
    for (int i = 1; i <= 20; ++i) {
      const double at_s = 0.2 * i;
      const hardware::CommandBytes bytes =
          hardware::Encode(hardware::CommandFrame{static_cast<std::uint8_t>(i), {}});
      robot.Receive(at_s, bytes);
      robot.Advance(at_s + 0.19, [](const auto&, const auto&) {});
      const auto said = robot.Transmit(at_s + 0.19);
      if (const auto answer = hardware::DecodeAnswer(said)) heard.push_back(*answer->sequence);
      there.Put(at_s, bytes);
      if (there.Take(1e9).empty()) continue;
      back.Put(at_s, hardware::Encode(hardware::Answer{.sequence = 0}));
      if (!back.Take(1e9).empty()) expected.push_back(i);
    }
    INFO(seed);
    CHECK(heard == expected);
    CHECK(expected.size() > 2);
  }
}

TEST_CASE("A byte's line time follows the baud rate, and a line waits for the one before") {
  simulation::LinkOptions options{.delay_s = 0.5, .baud = 100.0};  // 0.1 s a byte
  ByteChannel channel(options, 1);
  channel.Put(1.0, {});
  channel.Put(2.0, std::vector<std::uint8_t>{1});
  channel.Put(4.0, std::vector<std::uint8_t>{2});
  CHECK(channel.Take(2.59).empty());
  CHECK(channel.Take(2.61).size() == 1);
  CHECK(channel.Take(4.59).empty());
  CHECK(channel.Take(4.61).size() == 1);
  ByteChannel fast({.delay_s = 0.5, .baud = 0.0}, 1);
  fast.Put(1.0, std::vector<std::uint8_t>{1, 2, 3});
  CHECK(fast.Take(1.499).empty());
  CHECK(fast.Take(1.5).size() == 3);
}

TEST_CASE("Every byte goes through the twin's serial port as it is") {
  PseudoTerminal robot;
  CHECK(robot.Read().empty());
  const hardware::LineOptions options;
  hardware::SerialPort host(robot.path(), options.baud, options.write_timeout_s);
  std::vector<std::uint8_t> all;
  for (int i = 0; i < 256; ++i) all.push_back(static_cast<std::uint8_t>(i));
  host.Write(all);
  std::vector<std::uint8_t> heard;
  while (heard.size() < all.size()) {
    const auto more = robot.Read();
    heard.insert(heard.end(), more.begin(), more.end());
  }
  CHECK(heard == all);
  robot.Write(all);
  std::vector<std::uint8_t> back;
  while (back.size() < all.size()) {
    const auto more = host.Read();
    back.insert(back.end(), more.begin(), more.end());
  }
  CHECK(back == all);
}

}  // namespace
}  // namespace rift::twin
