// The shape of errors of robots that drive any way: about half a turn the yaw leaps.
#include "rift/sweep/calibrate/error_structure.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "support/inputs/paths.hpp"

namespace rift::sweep {
namespace {

/// Weaves along a line from the origin in that direction, seen exactly.
SimulatedTrial Along(double direction_rad, double delay_s) {
  SimulatedTrial trial{
      .task = std::vector<control::Waypoint>{{.name = "a"},
                                             {.name = "b",
                                              .x_m = 1.5 * std::cos(direction_rad),
                                              .y_m = 1.5 * std::sin(direction_rad)}},
      .start = {0.0, 0.0, direction_rad + 0.3},
      .seed = 5};
  simulation::MocapOptions& mocap = trial.simulation.mocap;
  mocap.noise_across_m = mocap.noise_along_m = mocap.noise_yaw_rad = 0.0;
  mocap.blur_across_s = mocap.stamp_jitter_s = mocap.blur_yaw_rad_per_mps = 0.0;
  trial.simulation.link.delay_s = delay_s;
  return trial;
}

TEST_CASE("Errors about half a turn have the structure that they have about none") {
  const trajectory::Trajectory log = Simulate(Along(0.0, 0.05)).result.trajectory;
  const auto structure = [&log](double direction_rad) {
    trajectory::Trajectory turned = test::Moved(log, {0.0, 0.0, direction_rad});
    size_t leaps = 0;
    for (size_t i = 0; i < turned.poses.size(); ++i) {
      double& yaw_rad = turned.poses[i].yaw_rad;
      yaw_rad = std::remainder(yaw_rad, 2.0 * std::numbers::pi);
      leaps += i > 0 && std::abs(yaw_rad - turned.poses[i - 1].yaw_rad) > 3.0;
    }
    CHECK((leaps > 4) == (direction_rad != 0.0));
    const auto twin = [&](size_t, const std::vector<double>&) {
      return Along(direction_rad, 0.15);
    };
    return StructureOfErrors({{.name = "1", .log = turned}}, twin, {},
                             {.most_frames = 3, .phases = 2, .moved_m = 0.05});
  };
  const ErrorStructure none = structure(0.0);
  for (const double half_turn : {3.04, 3.09, std::numbers::pi, -3.04}) {
    const ErrorStructure half = structure(half_turn);
    CHECK(half.motions == none.motions);
    CHECK(half.lag_s == Approx(none.lag_s).margin(1e-6));
    CHECK(half.turned_rad == Approx(none.turned_rad).epsilon(1e-3));
    CHECK(half.ahead_m == Approx(none.ahead_m).epsilon(1e-3));
    CHECK(half.left_m == Approx(none.left_m).epsilon(1e-3));
    CHECK(half.turning_left_rad == Approx(none.turning_left_rad).epsilon(1e-3));
    CHECK(half.turning_right_rad == Approx(none.turning_right_rad).epsilon(1e-3));
    CHECK(half.frequency_hz == Approx(none.frequency_hz));
    CHECK(half.frequency_share == Approx(none.frequency_share).epsilon(1e-3));
  }
  CHECK(std::abs(none.lag_s) > 0.05);
}

}  // namespace
}  // namespace rift::sweep
