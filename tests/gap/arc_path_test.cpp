// Where a path begins and ends once standstill is left out, at the very radius and with known
// lengths.
#include "gap/arc_path.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <vector>

#include "rift/gap/comparison.hpp"
#include "rift/gap/doubts.hpp"
#include "support/inputs/paths.hpp"

namespace rift::gap {
namespace {

using trajectory::Trajectory;

/// A row a second along x, or up.
Trajectory Along(std::initializer_list<double> places_m, bool is_upwards = false) {
  Trajectory path;
  for (const double place_m : places_m) {
    trajectory::StampedPose pose{.t_s = static_cast<double>(path.poses.size()), .z_m = 0.0};
    (is_upwards ? pose.z_m : pose.x_m) = place_m;
    path.poses.push_back(pose);
  }
  return path;
}

GapOptions Trimmed(double radius_m, bool is_in_space = false) {
  GapOptions options;
  options.trim_standstill = true;
  options.standstill_radius_m = radius_m;
  if (is_in_space) options.dimension = Dimension::kXyz;
  return options;
}

TEST_CASE("A row at the standstill radius itself still stands, at the start and at the end") {
  for (const bool is_in_space : {false, true}) {
    // The second row is 0.25 m from the first, the last but one 0.25 m from the last.
    const Trajectory path = Along({0.0, 0.25, 1.0, 2.0, 2.25}, is_in_space);
    const auto rows = [&](double radius_m) {
      const GapOptions options = Trimmed(radius_m, is_in_space);
      std::vector<double> times_s;
      const auto poses = is_in_space ? MakeArcPathIn<3>(path, options).poses
                                     : MakeArcPathIn<2>(path, options).poses;
      for (const auto& pose : poses) times_s.push_back(pose.t_s);
      return times_s;
    };
    CHECK(rows(0.25) == std::vector<double>{1.0, 2.0, 3.0});
    CHECK(rows(std::nextafter(0.25, 0.0)) == std::vector<double>{0.0, 1.0, 2.0, 3.0, 4.0});
    GapOptions options = Trimmed(2.25, is_in_space);
    CHECK(IsStanding(path, options));
    CHECK(MovingLength_m(path, options) == 0.0);
    options.standstill_radius_m = std::nextafter(2.25, 0.0);
    CHECK_FALSE(IsStanding(path, options));
    CHECK(MovingLength_m(path, options) == Approx(2.25));
  }
}

TEST_CASE("A path that ends before it has left its start for good is taken as it is") {
  // The middle row is the last one near the first and the first one near the last.
  const Trajectory creeps = Along({0.0, 0.008, 0.016});
  const Comparison result = Compare(creeps, test::StraightPath(1.0, 11), Trimmed(0.01));
  CHECK(result.sim_length_m == Approx(0.016));
  CHECK(result.sim_standstill_share == 0.0);
}

TEST_CASE("What is logged beside the way counts with how far it led, in the plane and in space") {
  for (const bool is_in_space : {false, true}) {
    const GapOptions options = Trimmed(0.01, is_in_space);
    // To and fro by 4 mm before the way, which begins at 3 mm, and behind it to 6 mm further on.
    const Trajectory path = Along({0.0, 0.004, 0.003, 1.0, 1.004, 1.006}, is_in_space);
    CHECK(MovingLength_m(path, options) == Approx(0.003 + 0.997 + 0.006));
    const Trajectory other = Along({0.0, 1.0}, is_in_space);
    const double share = (0.004 + 0.001 + 0.004 + 0.002) / 1.008;
    Comparison result = Compare(path, other, options);
    CHECK(result.sim_standstill_share == Approx(share));
    CHECK(result.real_standstill_share == 0.0);
    CHECK(result.sim_length_m == Approx(0.997));
    CHECK(result.real_length_m == Approx(1.0));
    result = Compare(other, path, options);
    CHECK(result.sim_standstill_share == 0.0);
    CHECK(result.real_standstill_share == Approx(share));
  }
  // A way straight up is none in the plane.
  const Trajectory up = Along({0.0, 0.5, 1.0}, true);
  CHECK(MovingLength_m(up, Trimmed(0.01, true)) == Approx(1.0));
  CHECK(MovingLength_m(up, Trimmed(0.01)) == 0.0);
}

TEST_CASE("A path without an arc length is refused with why") {
  const Trajectory good = Along({0.0, 1.0});
  const auto refused = [&](const Trajectory& path, const GapOptions& options, const char* says) {
    CHECK_THROWS_WITH(Gap(path, good, options), says);
    CHECK_THROWS_WITH(Gap(good, path, options), says);
  };
  refused(Along({0.0}), {}, "a path of fewer than two poses has no arc length");
  refused(Along({0.5, 0.5}), {}, "the path has zero length: the robot never moved");
  refused(Along({0.0, 1e308, -1e308}), {},
          "the length of the path is not finite: a position is NaN or huge");
  Trajectory flat = Along({0.0, 1.0, 2.0});
  flat.poses[2].z_m = std::numeric_limits<double>::quiet_NaN();
  GapOptions space;
  space.dimension = Dimension::kXyz;
  refused(flat, space,
          "the pose at 2 s has no height z, and the gap in space (dimension xyz) needs it: use "
          "dimension xy");
}

TEST_CASE("In space the start alone is moved without a turn, and no planar motion is told") {
  Trajectory sim = Along({0.0, 1.0}), real = Along({0.5, 1.5});
  for (auto& pose : sim.poses) pose.yaw_rad = 0.1;
  for (auto& pose : real.poses) {
    pose.yaw_rad = 0.3;
    pose.z_m += 0.25;
  }
  GapOptions options;
  options.dimension = Dimension::kXyz;
  options.align = Align::kStart;
  const Comparison result = Compare(sim, real, options);
  CHECK(result.gap_m == Approx(0.0).margin(1e-12));
  CHECK(result.mean_yaw_error_rad == Approx(0.2));  // the yaws are still known
  CHECK(std::isnan(result.real_from_sim.x_m));
  CHECK(std::isnan(result.real_from_sim.y_m));
  CHECK(std::isnan(result.real_from_sim.yaw_rad));
}

TEST_CASE("A motion that is not of the dimension is refused with the one that is") {
  const Trajectory path = Along({0.0, 1.0});
  CHECK_THROWS_WITH(ProfileAlong(path, path, {.dimension = Dimension::kXyz, .align = Align::kSe2}),
                    "align is se2, a motion in the plane, and dimension is xyz: use se3");
  CHECK_THROWS_WITH(
      TimesAlong_s(path, {.align = Align::kSe3}),
      "align is se3, a motion in space, and dimension is xy: use se2, or dimension xyz");
}

}  // namespace
}  // namespace rift::gap
