#include "view/trail.hpp"

#include <catch2/catch.hpp>

namespace rift::view {
namespace {

const std::vector<Eigen::Vector2d> kPath{{0.0, 0.0}, {1.0, 0.0}, {1.0, 0.0}, {1.0, 1.0}};

SceneRobot Following(const std::vector<Eigen::Vector2d>& points_m) {
  SceneRobot robot;
  for (const Eigen::Vector2d& p_m : points_m) ExtendTrail(p_m, kPath, robot);
  return robot;
}

TEST_CASE("Lines to the path begin two centimetres apart and end at its nearest point") {
  const SceneRobot robot = Following(
      {{0.1, 0.05}, {0.119, 0.05}, {0.121, 0.05}, {0.139, 0.05}, {0.5, -0.03}, {1.2, 0.6}});
  CHECK(robot.trail_m.size() == 6);
  const std::vector<LateralLine>& lines = robot.beside.lines;
  REQUIRE(lines.size() == 4);
  CHECK((lines[0].from_m - Eigen::Vector2d(0.1, 0.05)).norm() < 1e-12);
  CHECK((lines[0].to_m - Eigen::Vector2d(0.1, 0.0)).norm() < 1e-12);
  CHECK(lines[1].from_m.x() == 0.121);
  CHECK((lines[2].to_m - Eigen::Vector2d(0.5, 0.0)).norm() < 1e-12);
  CHECK((lines[3].to_m - Eigen::Vector2d(1.0, 0.6)).norm() < 1e-12);
  CHECK(robot.beside.largest_m == Approx(0.2));
}

TEST_CASE("A trail without a path has no lines to it") {
  SceneRobot robot;
  for (const double x_m : {0.0, 0.1}) ExtendTrail({x_m, 0.05}, {{0.0, 0.0}}, robot);
  CHECK(robot.trail_m.size() == 2);
  CHECK(robot.beside.lines.empty());
  CHECK(robot.beside.largest_m == 0.0);
}

TEST_CASE("The largest distance is that of all points, between lines and left out by now alike") {
  SceneRobot robot = Following({{0.1, 0.01}, {0.11, 0.015}});
  CHECK(robot.beside.lines.size() == 1);
  CHECK(robot.beside.largest_m == Approx(0.015));
  // To and fro 3 mm beside the path, a line from each eighth point, until both are left out.
  for (std::size_t i = 0; i < kTrailLength; ++i) {
    ExtendTrail({0.2 + 0.0026 * static_cast<double>(i % 200), 0.003}, kPath, robot);
  }
  REQUIRE(robot.trail_m.size() == kTrailLength);
  CHECK(robot.trail_m.front() == Eigen::Vector2d(0.2, 0.003));
  CHECK(robot.beside.lines.size() == kTrailLength / 8);
  CHECK(robot.beside.lines.front().from_m == robot.trail_m.front());
  CHECK(robot.beside.largest_m == Approx(0.015));
  ClearTrail(robot);
  CHECK(robot.trail_m.empty());
  CHECK(robot.beside.lines.empty());
  CHECK(robot.beside.largest_m == 0.0);
}

}  // namespace
}  // namespace rift::view
