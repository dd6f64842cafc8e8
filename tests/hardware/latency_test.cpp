#include "rift/hardware/latency.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "bench.hpp"

namespace rift::hardware {
namespace {

TEST_CASE("A camera's latency is measured by a turn to and fro") {
  for (const double late_s : {0.0, 0.06, 0.12, 0.5, 0.9}) {
    Bench bench;
    bench.camera_late_s = late_s;
    HardwareOptions hardware;
    RealRobot robot(bench, bench, bench, {hardware, Protocol::kFramed, false});
    for (int i = 0; i < 100; ++i) robot.Advance(0.02);
    robot.Arm();
    const std::optional<LatencyResult> found =
        MeasureLatency(robot, hardware.odometry, hardware.turn, 0.04);
    REQUIRE(found);
    INFO("late by " << late_s << " s, measured " << *found->delay.camera_s);
    CHECK(std::abs(*found->delay.camera_s - late_s) < 0.02);
    CHECK(found->turned_deg < 10.0);
    CHECK(*found->delay.robot_s == Approx(0.06).margin(0.04));  // motors of 0.05 s, and the line
    CHECK(std::abs(bench.Pose().yaw_rad) < 0.1);                // it stands as it stood
  }
}

}  // namespace
}  // namespace rift::hardware
