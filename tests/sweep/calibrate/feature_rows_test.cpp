// What the end of a row of features says: on which side each waypoint was passed.
#include "sweep/calibrate/feature_rows.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "support/mirror.hpp"

namespace rift::sweep {
namespace {

using control::Waypoint;

/// One row for each waypoint but the first, `left_m` beside it, seen from the one before.
struct Drive {
  explicit Drive(std::vector<Waypoint> waypoints) { twin.task.waypoints = std::move(waypoints); }

  void Pass(size_t waypoint, double left_m) {
    const Eigen::Vector2d from = twin.task.waypoints[waypoint - 1].Position();
    const Eigen::Vector2d to = twin.task.waypoints[waypoint].Position();
    const Eigen::Vector2d ahead = (to - from).normalized();
    const Eigen::Vector2d at = to + left_m * Eigen::Vector2d(-ahead.y(), ahead.x());
    path.poses.push_back({.t_s = 0.05 * static_cast<double>(path.poses.size()),
                          .x_m = at.x(),
                          .y_m = at.y(),
                          .target_x_m = to.x(),
                          .target_y_m = to.y()});
  }
  std::vector<double> Sides() const {
    const Eigen::VectorXd row = FeatureRow(path, twin);
    const auto count = static_cast<Eigen::Index>(twin.task.waypoints.size()) - 1;
    return {row.end() - count, row.end()};
  }

  SimulatedTrial twin;
  trajectory::Trajectory path;
};

TEST_CASE("A waypoint is passed to the left or to the right of the way there, by the last row") {
  test::OnBothSides("left", "right", [](const test::Side& side) {
    const double sign = side.IsFirst() ? 1.0 : -1.0;
    Drive drive({{.name = "a"}, {.name = "b", .x_m = 1.0}, {.name = "c", .x_m = 1.0, .y_m = 1.0}});
    drive.Pass(1, 0.3);
    drive.Pass(1, sign * 0.02);
    drive.Pass(2, -sign * 0.01);
    const std::vector<double> sides = drive.Sides();
    CHECK(sides[0] == Approx(sign * 0.02));
    CHECK(sides[1] == Approx(-sign * 0.01));
  });
}

TEST_CASE("A place that is driven to twice is passed twice, each time from where the robot came") {
  Drive drive({{.name = "a"},
               {.name = "b", .x_m = 1.0},
               {.name = "c", .x_m = 1.0, .y_m = 1.0},
               {.name = "b again", .x_m = 1.0}});
  drive.Pass(1, 0.01);
  drive.Pass(2, 0.02);
  CHECK(std::isnan(drive.Sides()[2]));
  drive.Pass(3, -0.03);
  const std::vector<double> sides = drive.Sides();
  CHECK(sides[0] == Approx(0.01));
  CHECK(sides[1] == Approx(0.02));
  CHECK(sides[2] == Approx(-0.03));
}

}  // namespace
}  // namespace rift::sweep
