// What a written log looks like, byte for byte.
#include <catch2/catch.hpp>
#include <numbers>
#include <string>
#include <vector>

#include "rift/trajectory/log.hpp"

namespace rift::trajectory {
namespace {

TEST_CASE("A row has its fields in the order of its header, empty where nothing was logged") {
  StampedPose pose{.t_s = 0.5, .x_m = 1.0, .y_m = -2.0};
  CHECK(RiftRow(pose, {}) == "0.5,1,-2,,,,,,\n");
  const std::vector<double> channels{7.0, StampedPose::kNotLogged, 0.1};
  CHECK(RiftRow(pose, channels) == "0.5,1,-2,,,,,,,7,,0.1\n");
  pose = {.t_s = 0.5,
          .x_m = 1.5,
          .y_m = 2.5,
          .z_m = 3.5,
          .roll_rad = 4.5,
          .pitch_rad = 5.5,
          .yaw_rad = 6.5,
          .target_x_m = 7.5,
          .target_y_m = 8.5};
  CHECK(RiftRow(pose, {}) == "0.5,1.5,2.5,3.5,4.5,5.5,6.5,7.5,8.5\n");
  Trajectory log{{pose}, {{"power, left", {9.5}}, {"count", {10.0}}}};
  CHECK(WriteRift(log) ==
        "t_s,x_m,y_m,z_m,roll_rad,pitch_rad,yaw_rad,target_x_m,target_y_m,\"power, left\",count\n"
        "0.5,1.5,2.5,3.5,4.5,5.5,6.5,7.5,8.5,9.5,10\n");
}

TEST_CASE("A row for evo has its place and its quaternion, zeros where nothing was logged") {
  Trajectory log;
  log.poses = {{.t_s = 0.25, .x_m = 1.0, .y_m = -2.0},
               {.t_s = 0.5, .x_m = 3.0, .y_m = 4.0, .z_m = 5.0, .yaw_rad = 0.0}};
  CHECK(WriteTum(log) == "0.25 1 -2 0 0 0 0 1\n0.5 3 4 5 0 0 0 1\n");
}

TEST_CASE("A body is rolled about x, then pitched about y, then turned about z") {
  constexpr double kQuarter = std::numbers::pi / 2.0;
  const auto body_x = [](const StampedPose& pose) {
    return Eigen::Vector3d(WorldFromBody(pose) * Eigen::Vector3d::UnitX());
  };
  const auto body_y = [](const StampedPose& pose) {
    return Eigen::Vector3d(WorldFromBody(pose) * Eigen::Vector3d::UnitY());
  };
  using Eigen::Vector3d;
  CHECK((body_x({.yaw_rad = kQuarter}) - Vector3d::UnitY()).norm() < 1e-12);
  CHECK((body_x({.pitch_rad = kQuarter}) + Vector3d::UnitZ()).norm() < 1e-12);
  CHECK((body_y({.roll_rad = kQuarter}) - Vector3d::UnitZ()).norm() < 1e-12);
  // Pitched down its nose points down whatever the yaw; its left wing follows the yaw.
  const StampedPose both{.pitch_rad = kQuarter, .yaw_rad = kQuarter};
  CHECK((body_x(both) + Vector3d::UnitZ()).norm() < 1e-12);
  CHECK((body_y(both) + Vector3d::UnitX()).norm() < 1e-12);
  // Rolled to its left wing up, and pitched: the wing stays where the pitch takes it.
  const StampedPose rolled{.roll_rad = kQuarter, .pitch_rad = kQuarter};
  CHECK((body_y(rolled) - Vector3d::UnitX()).norm() < 1e-12);
}

}  // namespace
}  // namespace rift::trajectory
