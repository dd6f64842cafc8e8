#include "rift/vision/camera/frame.hpp"

#include <catch2/catch.hpp>
#include <cmath>

namespace rift::vision {
namespace {

TEST_CASE("A region is cut to the picture on each side, and one beside it is empty") {
  CHECK(Clipped({2, 3, 4, 5}, 20, 10) == Region{2, 3, 4, 5});
  CHECK(Clipped({-2, -3, 4, 5}, 20, 10) == Region{0, 0, 2, 2});
  CHECK(Clipped({18, 7, 4, 5}, 20, 10) == Region{18, 7, 2, 3});
  CHECK(Clipped({-1, -1, 100, 100}, 20, 10) == Region{0, 0, 20, 10});
  for (const Region& outside :
       {Region{20, 0, 4, 4}, {0, 10, 4, 4}, {-4, 0, 4, 4}, {0, -4, 4, 4}, {30, 30, 4, 4}}) {
    CHECK(Clipped(outside, 20, 10).empty());
  }
  CHECK(Region{1, 1, 0, 5}.empty());
  CHECK(Region{1, 1, 5, 0}.empty());
  CHECK(Region{1, 1, 5, -1}.empty());
  CHECK_FALSE(Region{1, 1, 1, 1}.empty());
}

TEST_CASE("Between pixels a grey value is the mean of the four around by how near they are") {
  // Three by two pixels at (10, 20).
  const GreyPatch patch{{10, 20, 3, 2}, {10, 20, 60, 110, 160, 10}};
  CHECK(patch.At(10.0, 20.0) == 10.0);
  CHECK(patch.At(12.0, 20.0) == 60.0);
  CHECK(patch.At(10.0, 21.0) == 110.0);
  CHECK(patch.At(12.0, 21.0) == 10.0);
  CHECK(patch.At(10.25, 20.0) == Approx(12.5));
  CHECK(patch.At(11.75, 20.0) == Approx(50.0));
  CHECK(patch.At(10.0, 20.25) == Approx(35.0));
  CHECK(patch.At(11.5, 20.75) == Approx(0.25 * 40.0 + 0.75 * 85.0));
  for (const auto& [x, y] : {std::pair{9.99, 20.0}, {12.01, 20.0}, {10.0, 19.99}, {10.0, 21.01}}) {
    CHECK_FALSE(patch.Holds(x, y));
    CHECK(std::isnan(patch.At(x, y)));
  }
  CHECK(std::isnan(patch.At(NAN, 20.0)));
  // A row, a column and a single pixel.
  const GreyPatch row{{0, 0, 2, 1}, {10, 30}}, column{{0, 0, 1, 2}, {10, 30}},
      one{{5, 5, 1, 1}, {70}};
  CHECK(row.At(0.5, 0.0) == 20.0);
  CHECK(column.At(0.0, 0.5) == 20.0);
  CHECK(one.At(5.0, 5.0) == 70.0);
}

}  // namespace
}  // namespace rift::vision
