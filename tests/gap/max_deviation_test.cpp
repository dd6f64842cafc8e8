// Points and errors of a profile, and how many vertices a long path is looked at in.
#include <Eigen/Core>
#include <catch2/catch.hpp>
#include <cmath>

#include "rift/gap/comparison.hpp"
#include "support/inputs/paths.hpp"

namespace rift::gap {
namespace {

using test::StraightPath;
using trajectory::Trajectory;

TEST_CASE("A profile without its start holds the samples that are left, each with its points") {
  Trajectory sim = StraightPath(2.0, 5), real = StraightPath(2.0, 5);
  for (auto& pose : sim.poses) pose.z_m = 0.5;
  for (auto& pose : real.poses) {
    pose.y_m = 0.25;
    pose.z_m = 0.5 + pose.x_m;
    pose.yaw_rad = 0.5;
  }
  GapOptions options;
  options.samples = 11;
  options.skip_start = 0.3;
  const ErrorProfile plane = ProfileAlong(sim, real, options);
  REQUIRE(plane.u.size() == 8);  // 11 samples less int(0.3 * 11)
  for (size_t i = 0; i < 8; ++i) {
    const double u = 0.1 * static_cast<double>(i + 3);
    CHECK(plane.u[i] == Approx(u));
    CHECK(plane.error_m[i] == Approx(0.25));
    CHECK(plane.yaw_error_rad[i] == Approx(-0.5));
    CHECK((plane.sim_m[i] - Eigen::Vector2d(2.0 * u, 0.0)).norm() < 1e-12);
    CHECK((plane.real_m[i] - Eigen::Vector2d(2.0 * u, 0.25)).norm() < 1e-12);
  }
  CHECK(plane.error_m.size() == 8);
  CHECK(plane.yaw_error_rad.size() == 8);
  CHECK(plane.sim_m.size() == 8);
  CHECK(plane.real_m.size() == 8);
  CHECK(plane.sim_z_m.empty());
  options.dimension = Dimension::kXyz;
  const ErrorProfile space = ProfileAlong(sim, real, options);
  REQUIRE(space.sim_z_m.size() == 8);
  REQUIRE(space.real_z_m.size() == 8);
  for (size_t i = 0; i < 8; ++i) {
    const double u = 0.1 * static_cast<double>(i + 3);
    CHECK(space.sim_z_m[i] == 0.5);
    CHECK(space.real_z_m[i] == Approx(0.5 + 2.0 * u));
    CHECK(space.error_m[i] == Approx(std::hypot(0.25, 2.0 * u)));
  }
  CHECK(TimesAlong_s(sim, options).size() == 8);
  CHECK(TimesAlong_s(sim, options).front() == Approx(0.6));  // at 1 m/s from its first row on
}

TEST_CASE("Of 500 vertices each one is looked at, of 501 as many even points as that") {
  const auto hausdorff_m = [](int rows, bool is_sim) {
    const Trajectory straight = StraightPath(20.0, rows);
    Trajectory spiked = straight;
    spiked.poses[static_cast<size_t>(rows) / 3].y_m = 0.12;
    return is_sim ? Compare(spiked, straight, {}).hausdorff_m
                  : Compare(straight, spiked, {}).hausdorff_m;
  };
  for (const bool is_sim : {true, false}) {
    CHECK(hausdorff_m(500, is_sim) == Approx(0.12).epsilon(1e-9));
    // The tip lies between two of the points, which stand 40 mm apart on legs of 126 mm.
    CHECK(hausdorff_m(501, is_sim) < 0.1199);
    CHECK(hausdorff_m(501, is_sim) > 0.08);
  }
}

}  // namespace
}  // namespace rift::gap
