// Which random numbers a run takes for what: the same seed gives the same run in every version.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

#include "rift/simulation/link.hpp"
#include "rift/simulation/mocap.hpp"
#include "rift/simulation/simulated_robot.hpp"
#include "rift/statistics/random.hpp"

namespace rift::simulation {
namespace {

using statistics::CounterRandom;

/// What a camera sees of a robot that drives along x at this speed for a second, each pose once.
std::vector<trial::PoseMeasurement> SeenOf(Mocap mocap, double speed_mps) {
  mocap.Observe({.t_s = 0.0}, {.t_s = 1.0, .x_m = speed_mps});
  std::vector<trial::PoseMeasurement> seen;
  for (int ms = 0; ms <= 1200; ++ms) {
    const auto newest = mocap.Newest(0.001 * ms);
    if (newest && (seen.empty() || newest->captured_s != seen.back().captured_s)) {
      seen.push_back(*newest);
    }
  }
  return seen;
}

TEST_CASE("A frame takes its moment, its noise and its loss from the draws of its number") {
  MocapOptions options;
  options.rate_hz = 20.0;
  options.frame_jitter_s = 0.002;
  options.stamp_jitter_s = 0.003;
  options.dropout = 0.3;
  options.noise_spread = 0.7;
  for (const std::uint64_t seed : {1, 2, 77}) {
    const CounterRandom noise(seed, 22);
    const double phase_s = CounterRandom(seed, 20).Uniform(0, 0) / 20.0;
    for (const double speed_mps : {0.3, 0.0}) {
      const double factor =
          speed_mps > 0.0 ? 1.0 : std::exp(0.7 * CounterRandom(seed, 23).Normal(0, 0));
      const auto seen = SeenOf(Mocap(options, seed), speed_mps);
      size_t at = 0;
      for (std::uint64_t frame = 0; frame < 18; ++frame) {
        if (noise.Uniform(frame, 14) < 0.3) continue;
        const double t_s = phase_s + 0.05 * static_cast<double>(frame) +
                           0.002 * noise.Normal(frame, std::uint64_t{21} << 8);
        REQUIRE(at < seen.size());
        const trial::PoseMeasurement& pose = seen[at++];
        INFO(seed << " " << frame);
        CHECK(pose.captured_s == Approx(t_s + 0.003 * noise.Normal(frame, 6)).margin(1e-12));
        CHECK(pose.world_from_robot.x_m ==
              Approx(speed_mps * t_s + factor * options.noise_along_m * noise.Normal(frame, 2))
                  .margin(1e-12));
        CHECK(pose.world_from_robot.y_m == Approx(std::hypot(factor * options.noise_across_m,
                                                             options.blur_across_s * speed_mps) *
                                                  noise.Normal(frame, 0))
                                               .margin(1e-12));
        CHECK(pose.world_from_robot.yaw_rad ==
              Approx(std::hypot(factor * options.noise_yaw_rad,
                                options.blur_yaw_rad_per_mps * speed_mps) *
                     noise.HeavyTailed(frame, 4, options.yaw_tail_dof))
                  .margin(1e-12));
        CHECK(pose.z_m == Approx(options.noise_z_m * noise.Normal(frame, 8)).margin(1e-12));
        CHECK(pose.roll_rad ==
              Approx(options.noise_tilt_rad * noise.Normal(frame, 10)).margin(1e-12));
        CHECK(pose.pitch_rad ==
              Approx(options.noise_tilt_rad * noise.Normal(frame, 12)).margin(1e-12));
      }
      CHECK(at > 5);
    }
  }
}

TEST_CASE("A host takes its period, its turns and the late ones from the draws of run and turn") {
  MocapOptions options;
  options.rate_hz = 1000.0;  // a frame always waits
  options.exposure_s = options.processing_s = 0.0;
  options.host_period_s = 0.04;
  options.host_period_spread_s = 0.004;
  options.host_wander_s = 0.0005;
  options.host_jitter_s = 0.002;
  options.host_late_share = 0.3;
  options.host_late_s = 0.015;
  for (const std::uint64_t seed : {1, 2, 3, 4}) {
    const CounterRandom run(seed, 23), host(seed, 24);
    const double period_s = 0.04 + 0.004 * run.Normal(0, 2), late_share = 0.6 * run.Uniform(0, 4);
    double done_s = period_s * CounterRandom(seed, 20).Uniform(1, 0), wandered_s = 0.0;
    REQUIRE(done_s > 0.002);
    const auto seen = SeenOf(Mocap(options, seed), 0.3);
    REQUIRE(seen.size() > 12);
    for (std::uint64_t turn = 0; turn < 12; ++turn) {
      wandered_s += 0.0005 * host.Normal(turn, 0);
      done_s += std::max(0.5 * period_s, period_s + wandered_s + 0.002 * host.Normal(turn, 2) +
                                             (host.Uniform(turn, 4) < late_share ? 0.015 : 0.0));
      INFO(seed << " " << turn);
      CHECK(seen[turn].captured_s == Approx(done_s).margin(1e-12));
    }
  }
}

TEST_CASE("A frame is late at the host's driver by the draw of its number") {
  MocapOptions options;
  options.rate_hz = 20.0;
  options.exposure_s = options.processing_s = options.frame_jitter_s = 0.0;
  options.host_period_s = 0.006;  // a host that waits for each frame, and stamps it 6 ms later
  options.host_period_spread_s = options.host_wander_s = options.host_jitter_s = 0.0;
  options.host_late_share = 0.0;
  options.arrival_jitter_s = 0.004;
  for (const std::uint64_t seed : {1, 2, 3, 77}) {
    const CounterRandom noise(seed, 22);
    const double phase_s = CounterRandom(seed, 20).Uniform(0, 0) / 20.0;
    REQUIRE(phase_s > options.host_period_s);
    const auto seen = SeenOf(Mocap(options, seed), 0.3);
    REQUIRE(seen.size() >= 19);
    for (std::uint64_t frame = 0; frame < 19; ++frame) {
      INFO(seed << " " << frame);
      const double arrives_s =
          phase_s + 0.05 * static_cast<double>(frame) + 0.004 * std::abs(noise.Normal(frame, 16));
      CHECK(seen[frame].captured_s == Approx(arrives_s + 0.006).margin(1e-12));
    }
  }
}

LinkOptions Direct() { return {.delay_s = 0.0, .baud = 0.0, .poll_s = 0.0}; }

TEST_CASE("A link takes its phase, its losses and its beginning from draws of their own") {
  LinkOptions polls = Direct(), loses = Direct(), late = Direct();
  polls.poll_s = 0.1;
  loses.line_loss = 0.4;
  late.late_share = 0.5;
  late.late_s = 2.0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    INFO(seed);
    const double phase_s = 0.1 * CounterRandom(seed, 10).Uniform(0, 0);
    Link polled(polls, seed);
    polled.Send(0.0, {0.5, 0.5});
    polled.Advance(phase_s - 1e-6);
    CHECK(polled.Held().left == 0.0);
    polled.Advance(phase_s + 1e-6);
    CHECK(polled.Held().left == 0.5);

    Link lossy(loses, seed);
    for (int line = 0; line < 20; ++line) {
      const double power = 0.01 * (line + 1);
      lossy.Send(0.1 * line, {power, power});
      lossy.Advance(0.1 * line);
      const bool is_lost = CounterRandom(seed, 11).Uniform(line, 1'000'000) < 0.4;
      CHECK((lossy.Held().left == Approx(power)) != is_lost);
    }

    const CounterRandom connection(seed, 12);
    const bool is_late = connection.Uniform(0, 0) < 0.5;
    const double heard_s = is_late ? -2.0 * std::log(connection.Uniform(0, 1)) : 0.0;
    Link link(late, seed);
    if (is_late) {
      link.Send(heard_s - 1e-6, {0.25, 0.25});
      link.Advance(heard_s - 1e-6);
      CHECK(link.Held().left == 0.0);
    }
    link.Send(heard_s + 1e-6, {0.5, 0.5});
    link.Advance(heard_s + 1e-6);
    CHECK(link.Held().left == 0.5);
  }
}

TEST_CASE("Which bytes of a line are lost is drawn for each of them by its place") {
  LinkOptions options = Direct();
  options.byte_loss = 0.15;
  int whole = 0, changed = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    const CounterRandom drawn(seed, 11);
    Link link(options, seed);
    for (std::uint64_t line = 0; line < 3; ++line) {
      const std::string text = "0.25 0.75\n";
      std::string heard;
      for (size_t i = 0; i < text.size(); ++i) {
        if (drawn.Uniform(line, i) >= 0.15) heard += text[i];
      }
      if (!heard.ends_with('\n')) break;  // it goes on with the next line
      const control::WheelPower before = link.Held();
      link.Send(static_cast<double>(line), {0.25, 0.75});
      link.Advance(static_cast<double>(line));
      char* rest = nullptr;
      const double left = std::strtod(heard.c_str(), &rest);
      char* end = nullptr;
      const double right = std::strtod(rest, &end);
      const bool is_understood = end != rest && *rest != '\n';
      INFO(seed << " " << line << ": " << heard);
      CHECK(link.Held().left == (is_understood ? std::min(left, 1.0) : before.left));
      CHECK(link.Held().right == (is_understood ? std::min(right, 1.0) : before.right));
      whole += heard == text;
      changed += heard != text;
    }
  }
  CHECK(whole > 5);
  CHECK(changed > 30);
}

SimulationOptions Steady() {
  SimulationOptions options;
  options.motor.model = MotorModel::kServo;
  options.link = {.delay_s = 0.0, .baud = 0.0, .poll_s = 0.0, .two_decimals = false};
  return options;
}

TEST_CASE("A run's mismatch is drawn for the run") {
  SimulationOptions options = Steady();
  options.motor.mismatch = 0.01;
  options.motor.mismatch_spread = 0.05;
  for (const std::uint64_t seed : {1, 2, 3, 4}) {
    SimulatedRobot robot(options, {}, seed);
    robot.Command({0.2, 0.2});
    robot.Advance(0.4);
    const auto& rate_rad_s = robot.State().wheel_rate_rad_s;
    const double mismatch = 0.01 + 0.05 * CounterRandom(seed, 30).Normal(0, 0);
    INFO(seed);
    CHECK((rate_rad_s[0] - rate_rad_s[1]) / (0.5 * (rate_rad_s[0] + rate_rad_s[1])) ==
          Approx(mismatch).margin(1e-3));
  }
}

}  // namespace
}  // namespace rift::simulation
