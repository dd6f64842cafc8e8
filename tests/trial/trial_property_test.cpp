// Whatever a robot reports, a trial ends, with finite rows, powers within one, and a robot that
// stands still.

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <random>

#include "rift/trial/trial.hpp"
#include "support/inputs/fake_robot.hpp"
#include "support/inputs/paper_waypoints.hpp"

namespace rift::trial {
namespace {

using Generator = std::mt19937_64;

double Between(Generator& generator, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(generator);
}

bool OneIn(Generator& generator, int n) {
  return std::uniform_int_distribution<int>(1, n)(generator) == 1;
}

void SpoilReading(Generator& generator, Sensed& sensed) {
  if (OneIn(generator, 4)) sensed.pose.reset();
  if (!sensed.pose) return;
  geometry::Pose2& pose = sensed.pose->world_from_robot;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  if (OneIn(generator, 10)) pose.x_m = nan;
  if (OneIn(generator, 10)) pose.y_m += Between(generator, -1e3, 1e3);
  if (OneIn(generator, 10)) pose.yaw_rad = Between(generator, -1e9, 1e9);
  if (OneIn(generator, 10)) sensed.pose->pitch_rad = Between(generator, -3.0, 3.0);
  if (OneIn(generator, 10)) sensed.pose->captured_s = Between(generator, -10.0, 10.0);
  if (OneIn(generator, 50)) sensed.pose->captured_s = nan;
}

void CheckTrial(const TrialResult& result, const TrialOptions& options) {
  for (const trajectory::StampedPose& row : result.trajectory.poses) {
    REQUIRE((std::isfinite(row.t_s) && row.Planar().IsFinite()));
  }
  for (const SentCommand& command : result.commands) {
    REQUIRE((std::abs(command.power.left) <= 1.0 && std::abs(command.power.right) <= 1.0));
  }
  REQUIRE(result.Duration_s() <= options.timeout_s + 1.0);
  REQUIRE_FALSE(result.reason.empty());
}

TEST_CASE("Two hundred trials on spoiled readings end in order and at rest") {
  Generator generator(7);
  size_t driven = 0;
  for (int run = 0; run < 200; ++run) {
    test::FakeRobotOptions robot_options;
    robot_options.world_from_start = control::StartPose(test::PaperWaypoints());
    robot_options.command_delay_s = Between(generator, 0.0, 0.5);
    robot_options.sensing_delay_s = Between(generator, 0.0, 0.3);
    robot_options.frame_period_s = Between(generator, 0.005, 0.2);
    test::FakeRobot robot(robot_options);
    robot.spoil = [&generator](Sensed& sensed) { SpoilReading(generator, sensed); };

    TrialOptions options;
    options.timeout_s = 6.0;
    options.control_period_s = Between(generator, 0.005, 0.1);
    options.pace = OneIn(generator, 2) ? Pace::kNewPose : Pace::kEveryPeriod;
    control::NavigatorOptions navigator;
    navigator.latency.delay_s = OneIn(generator, 2) ? Between(generator, 0.0, 0.6) : 0.0;
    const TrialResult result = RunTrial(robot, test::PaperWaypoints(), navigator, options);
    CheckTrial(result, options);
    REQUIRE(robot.stops == 1);
    REQUIRE(robot.power() == control::WheelPower{});
    driven += result.limits.decisions;
  }
  CHECK(driven > 2'000);
}

}  // namespace
}  // namespace rift::trial
