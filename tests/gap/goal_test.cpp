#include "rift/gap/goal.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "rift/gap/comparison.hpp"
#include "support/inputs/paths.hpp"

namespace rift::gap {
namespace {

const Goal kGoal{{0.7, 0.0}, 0.05};

trajectory::Trajectory Beside(trajectory::Trajectory path, double y_m) {
  for (trajectory::StampedPose& pose : path.poses) pose.y_m += y_m;
  return path;
}

TEST_CASE("How short of the goal a run stops is no part of the gap on the way") {
  const trajectory::Trajectory whole = test::StraightPath(0.7, 71);
  const trajectory::Trajectory shorter = test::StraightPath(0.66, 67);
  CHECK(Gap(shorter, whole, {}) == Approx(0.04));
  CHECK(WayGap_m(shorter, whole, kGoal, {}) == Approx(0.0).margin(1e-12));
  CHECK(WayGap_m(whole, shorter, kGoal, {}) == Approx(0.0).margin(1e-12));
}

TEST_CASE("What is beside the way counts up to the goal") {
  const trajectory::Trajectory whole = test::StraightPath(0.7, 71);
  const trajectory::Trajectory beside = Beside(test::StraightPath(0.69, 70), 0.03);
  CHECK(WayGap_m(beside, whole, kGoal, {}) == Approx(0.03).margin(1e-9));
}

TEST_CASE("A path that ends outside the radius or beyond the goal is left as it is") {
  const trajectory::Trajectory whole = test::StraightPath(0.7, 71);
  for (const double length_m : {0.6, 0.73}) {
    const trajectory::Trajectory other =
        test::StraightPath(length_m, static_cast<int>(std::lround(100.0 * length_m)) + 1);
    CHECK(WayGap_m(other, whole, kGoal, {}) == Approx(Gap(other, whole, {})));
  }
}

}  // namespace
}  // namespace rift::gap
