// How far a path that ended early was from the end of its task.
#include "sweep/falsify/simulated_recording.hpp"

#include <Eigen/Core>
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

namespace rift::sweep {
namespace {

const std::vector<control::Waypoint> kCorner{
    {.name = "a"}, {.name = "b", .x_m = 1.0}, {.name = "c", .x_m = 1.0, .y_m = 2.0}};

double Left_m(const std::vector<Eigen::Vector2d>& rows_m,
              const std::vector<control::Waypoint>& waypoints = kCorner) {
  trajectory::Trajectory log;
  for (const Eigen::Vector2d& row_m : rows_m) {
    log.poses.push_back(
        {.t_s = static_cast<double>(log.poses.size()), .x_m = row_m.x(), .y_m = row_m.y()});
  }
  return WayLeft_m(log, waypoints, 0.1);
}

TEST_CASE("The way left leads from the last row over the waypoints that were not reached") {
  CHECK(Left_m({{0.0, 0.0}}) == Approx(1.0 + 2.0));
  CHECK(Left_m({{0.0, 0.0}, {0.4, 0.3}}) == Approx(std::hypot(0.6, 0.3) + 2.0));
  CHECK(Left_m({{0.0, 0.0}, {0.95, 0.0}}) == Approx(2.0 + 0.0).margin(0.002));
  CHECK(Left_m({{0.0, 0.0}, {1.0, 0.0}, {1.0, 0.5}}) == Approx(1.5));
  CHECK(Left_m({{0.0, 0.0}, {1.0, 0.0}, {0.7, -0.4}}) == Approx(std::hypot(0.3, 2.4)));
  CHECK(Left_m({{0.0, 0.0}, {1.0, 0.0}, {1.0, 2.0}, {4.0, 4.0}}) == 0.0);
  CHECK(Left_m({{3.0, 3.0}}, {{.name = "a"}}) == 0.0);
  // One that is put down within reach of the first target has reached it.
  CHECK(Left_m({{1.05, 0.0}}) == Approx(std::hypot(0.05, 2.0)));
}

TEST_CASE("A waypoint is reached between two rows as well, within its radius and not beyond") {
  for (const double side : {1.0, -1.0}) {
    CHECK(Left_m({{0.0, 0.09 * side}, {1.8, 0.09 * side}}) ==
          Approx(std::hypot(0.8, 2.0 - 0.09 * side)));
    CHECK(Left_m({{0.0, 0.11 * side}, {1.8, 0.11 * side}}) == Approx(std::hypot(0.8, 0.11) + 2.0));
  }
  // A row ends before it, and the line through both rows would have passed it.
  CHECK(Left_m({{0.0, 0.0}, {0.5, 0.0}}) == Approx(0.5 + 2.0));
  CHECK(Left_m({{1.5, 0.0}, {1.8, 0.0}}) == Approx(0.8 + 2.0));
}

TEST_CASE("Waypoints are reached in their order, several of them between two rows, too") {
  CHECK(Left_m({{1.0, -1.0}, {1.0, 3.0}}) == 0.0);
  // From behind the end to before the corner: the end was passed too early.
  CHECK(Left_m({{1.0, 3.0}, {1.0, -1.0}}) == Approx(3.0));
  CHECK(Left_m({{1.0, 3.0}, {1.0, -1.0}, {1.0, 1.95}}) == 0.0);
  CHECK(Left_m({{1.0, 2.0}, {0.0, 2.0}, {0.0, 0.0}}) == Approx(1.0 + 2.0));
}

}  // namespace
}  // namespace rift::sweep
