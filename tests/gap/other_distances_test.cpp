#include "gap/other_distances.hpp"
#include "gap/path_shape.hpp"

#include <catch2/catch.hpp>

namespace rift::gap {
namespace {

TEST_CASE("Time warping is the mean distance along the cheapest walk") {
  // (0, 0), (1, 0 or 2), (2, 2): distances 0, 1, 0.
  const Points three{{0, 0}, {1, 0}, {2, 0}}, two{{0, 0}, {2, 0}};
  CHECK(DynamicTimeWarping_m(three, two) == Approx(1.0 / 3.0));
  CHECK(DynamicTimeWarping_m(two, three) == Approx(1.0 / 3.0));
  CHECK(DynamicTimeWarping_m({{0, 0}, {1, 0}}, {{0, 2}, {1, 2}}) == Approx(2.0));
  // Waiting at 0 costs nothing: four cells, one of them 3 long.
  CHECK(DynamicTimeWarping_m({{0, 0}, {0, 0}, {0, 0}, {5, 0}}, {{0, 0}, {5, 3}}) == Approx(0.75));
}

TEST_CASE("Frechet is the shortest leash and Hausdorff does not walk") {
  const Points there{{0, 0}, {1, 0}, {2, 0}}, back{{2, 0}, {1, 0}, {0, 0}};
  CHECK(DiscreteFrechet_m(there, back) == Approx(2.0));
  CHECK(Hausdorff_m(there, back) == 0.0);
  CHECK(Hausdorff_m(there, {{0, 0}, {1, 0.5}, {2, 0}}) == Approx(0.5));
}

}  // namespace
}  // namespace rift::gap
