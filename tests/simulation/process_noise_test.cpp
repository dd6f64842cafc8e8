// What no robot does twice: the ground's unevenness, and a pull to one side that differs from run
// to run.

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "rift/simulation/ode_world.hpp"
#include "rift/simulation/simulated_robot.hpp"
#include "rift/statistics/descriptive.hpp"

namespace rift::simulation {
namespace {

SimulationOptions Steady() {
  SimulationOptions options;
  options.motor.model = MotorModel::kServo;
  options.link = {.delay_s = 0.0, .baud = 0.0, .poll_s = 0.0, .two_decimals = false};
  return options;
}

TruePose After(const SimulationOptions& options, std::uint64_t seed, double power, double time_s) {
  SimulatedRobot robot(options, {}, seed);
  robot.Command({power, power});
  robot.Advance(time_s);
  return robot.Truth();
}

TEST_CASE("A wheel on uneven ground makes more or less way than its rim turns") {
  const BodyOptions body;
  OdeWorld world(body, Terrain(TerrainOptions{}), {}, 0.004);
  const WheelDrive servo{10.0, 0.0, 10.0};
  const auto moved = [&](const std::array<double, 2>& uneven) {
    OdeWorld robot(body, Terrain(TerrainOptions{}), {}, 0.004);
    for (int i = 0; i < 250; ++i) robot.Step({servo, servo}, uneven);
    return robot.State();
  };
  const double even_m = moved({}).position_m.x();
  CHECK(moved({0.05, 0.05}).position_m.x() == Approx(1.05 * even_m).epsilon(0.002));
  const WorldState turned = moved({-0.02, 0.02});
  const double yaw_rad = std::atan2(turned.world_from_robot(1, 0), turned.world_from_robot(0, 0));
  CHECK(yaw_rad == Approx(0.04 * 10.0 * body.wheel_radius_m / body.track_m).epsilon(0.04));
}

TEST_CASE("Uneven ground turns the robot as a random walk over its way") {
  SimulationOptions options = Steady();
  options.terrain.surfaces["ground"].unevenness = 0.08;
  const auto spread_rad = [&](double power, double time_s) {
    std::vector<double> yaws_rad;
    for (std::uint64_t seed = 0; seed < 150; ++seed) {
      yaws_rad.push_back(After(options, seed, power, time_s).yaw_rad);
    }
    return statistics::StandardDeviation(yaws_rad);
  };
  // Straight lines between normal values 5 mm apart: sigma^2 x 5 mm of variance for each metre.
  const double way_m = 0.2 * options.motor.NoLoad_rad_s() * 0.016 * 1.0;
  const double expected_rad = 0.08 * std::sqrt(2.0 * 0.005 * way_m) / options.body.track_m;
  const double near_rad = spread_rad(0.2, 1.0);
  CHECK(near_rad == Approx(expected_rad).epsilon(0.15));
  CHECK(spread_rad(0.2, 3.0) == Approx(std::sqrt(3.0) * near_rad).epsilon(0.25));
  CHECK(spread_rad(0.1, 2.0) == Approx(near_rad).epsilon(0.25));  // the way counts, not the time
}

TEST_CASE("The ground's unevenness changes along the way and never jumps") {
  SimulationOptions options = Steady();
  options.terrain.surfaces["ground"].unevenness = 0.2;
  SimulatedRobot robot(options, {}, 4);
  robot.Command({0.02, 0.02});  // 50 steps from grain to grain
  robot.Advance(0.4);
  double last_rad_s = robot.State().spin_rad_s.z(), least = last_rad_s, most = least, jump = 0.0;
  for (int i = 0; i < 1500; ++i) {
    robot.Advance(0.004);
    const double rate_rad_s = robot.State().spin_rad_s.z();
    jump = std::max(jump, std::abs(rate_rad_s - last_rad_s));
    least = std::min(least, rate_rad_s);
    most = std::max(most, rate_rad_s);
    last_rad_s = rate_rad_s;
  }
  CHECK(most - least > 0.05);  // 0.3 rad/s for a difference of one: of 0.2 and more
  CHECK(jump < 0.06 * (most - least));
}

TEST_CASE("What a session on a surface has of its own stands beside what the robot has") {
  SimulationOptions options;
  options.mocap.host_period_s = 0.05;
  constexpr std::array kScatters{&MocapOptions::noise_across_m,       &MocapOptions::blur_across_s,
                                 &MocapOptions::noise_along_m,        &MocapOptions::noise_yaw_rad,
                                 &MocapOptions::blur_yaw_rad_per_mps, &MocapOptions::noise_z_m,
                                 &MocapOptions::noise_tilt_rad};
  for (const auto scatter : kScatters) options.mocap.*scatter = 0.002;
  options.mocap.ambiguity.share = 0.5;
  options.motor.mismatch = 0.03;
  SurfaceOptions& surface = options.terrain.surfaces["cardboard"];
  surface.host_period_s = 0.06;
  surface.tracker_noise = 1.5;
  surface.mirrored_share = 0.4;
  surface.mirrored_runs = 0.7;
  surface.session_mismatch = -0.01;
  CHECK(*options.MocapOfSession().host_period_s == 0.05);
  for (const auto scatter : kScatters) CHECK(options.MocapOfSession().*scatter == 0.002);
  CHECK(options.MocapOfSession().ambiguity.share == 0.5);
  CHECK(options.MocapOfSession().ambiguity.runs == 1.0);
  CHECK(options.MotorOfSession().mismatch == 0.03);
  options.terrain.surface = "cardboard";
  CHECK(*options.MocapOfSession().host_period_s == 0.06);
  for (const auto scatter : kScatters) CHECK(options.MocapOfSession().*scatter == Approx(0.003));
  CHECK(options.MocapOfSession().ambiguity.share == Approx(0.2));
  CHECK(options.MocapOfSession().ambiguity.runs == Approx(0.7));
  CHECK(options.MocapOfSession().stamp_jitter_s == options.mocap.stamp_jitter_s);
  CHECK(options.MotorOfSession().mismatch == Approx(0.02));
  options.mocap.host_period_s.reset();
  CHECK_FALSE(options.MocapOfSession().host_period_s);
}

TEST_CASE("The session's mismatch turns the robot as the robot's own does, and either way") {
  for (const double mismatch : {-0.02, 0.02}) {
    const auto yaw_after = [&](bool is_of_session) {
      SimulationOptions options;
      options.link = LinkOptions{.delay_s = 0.0};
      (is_of_session ? options.terrain.surfaces["ground"].session_mismatch
                     : options.motor.mismatch) = mismatch;
      SimulatedRobot robot(options, {}, 1);
      robot.Command({0.3, 0.3});
      robot.Advance(1.0);
      return robot.Truth().yaw_rad;
    };
    CHECK(yaw_after(true) == yaw_after(false));
    CHECK(yaw_after(true) * mismatch < 0.0);
  }
}

TEST_CASE("Each run draws its own mismatch about the mean one") {
  SimulationOptions options = Steady();
  options.motor.mismatch = 0.02;
  options.motor.mismatch_spread = 0.03;
  std::vector<double> rates_rad_s;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    rates_rad_s.push_back(After(options, seed, 0.2, 1.0).yaw_rad);
  }
  const double rate_of_one =
      -0.2 * options.motor.NoLoad_rad_s() * options.body.wheel_radius_m / options.body.track_m;
  CHECK(statistics::Mean(rates_rad_s) == Approx(0.02 * rate_of_one).epsilon(0.3));
  CHECK(statistics::StandardDeviation(rates_rad_s) ==
        Approx(0.03 * std::abs(rate_of_one)).epsilon(0.15));
}

}  // namespace
}  // namespace rift::simulation
