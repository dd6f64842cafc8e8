#include "view/path_offset.hpp"

#include <catch2/catch.hpp>
#include <cmath>

namespace rift::view {
namespace {

TEST_CASE("How far a point lies off a path is left of its direction positive") {
  const std::vector<Eigen::Vector2d> path{{0.0, 0.0}, {1.0, 0.0}, {1.0, 1.0}};
  CHECK(PathOffset_m({0.5, 0.02}, path) == Approx(0.02));
  CHECK(PathOffset_m({0.5, -0.03}, path) == Approx(-0.03));
  CHECK(PathOffset_m({1.04, 0.5}, path) == Approx(-0.04));
  CHECK(std::abs(PathOffset_m({1.0, 1.05}, path)) == Approx(0.05));  // beyond its end
  CHECK(std::isnan(PathOffset_m({0.0, 0.0}, {{0.0, 0.0}})));
}

TEST_CASE("The way back and forth over one line changes the side") {
  CHECK(PathOffset_m({0.5, 0.01}, {{1.0, 0.0}, {0.0, 0.0}}) == Approx(-0.01));
}

TEST_CASE("An offset is told in millimetres with its side") {
  CHECK(OffsetText(0.0032) == "3.2 mm left");
  CHECK(OffsetText(-0.0118) == "11.8 mm right");
  CHECK(OffsetText(NAN) == "-");
}

TEST_CASE("Lines to the path begin two centimetres apart and end at its nearest point") {
  const std::vector<Eigen::Vector2d> path{{0.0, 0.0}, {1.0, 0.0}, {1.0, 0.0}, {1.0, 1.0}};
  const auto lines = LateralLines(
      {{0.1, 0.05}, {0.119, 0.05}, {0.121, 0.05}, {0.139, 0.05}, {0.5, -0.03}, {1.2, 0.6}}, path);
  REQUIRE(lines.size() == 4);
  CHECK((lines[0].from_m - Eigen::Vector2d(0.1, 0.05)).norm() < 1e-12);
  CHECK((lines[0].to_m - Eigen::Vector2d(0.1, 0.0)).norm() < 1e-12);
  CHECK(lines[0].Length_m() == Approx(0.05));
  CHECK(lines[1].from_m.x() == 0.121);
  CHECK((lines[2].to_m - Eigen::Vector2d(0.5, 0.0)).norm() < 1e-12);
  CHECK((lines[3].to_m - Eigen::Vector2d(1.0, 0.6)).norm() < 1e-12);
  CHECK(LateralLines({{0.1, 0.05}}, {{0.0, 0.0}}).empty());
  CHECK(LateralLines({{0.1, 0.05}}, {{0.0, 0.0}, {1.0, 0.0}}).size() == 1);
}

TEST_CASE("Before a path, beyond it and on a leg without length the distance is to its point") {
  const std::vector<Eigen::Vector2d> path{{0.0, 0.0}, {0.0, 0.0}, {0.0, 2.0}};
  CHECK(PathOffset_m({-0.3, -0.4}, path) == Approx(0.5));
  CHECK(PathOffset_m({0.3, 2.4}, path) == Approx(-0.5));
  CHECK(PathOffset_m({-0.1, 1.0}, path) == Approx(0.1));
  CHECK(OffsetText(0.0) == "0.0 mm left");
  CHECK(OffsetText(INFINITY) == "-");
}

}  // namespace
}  // namespace rift::view
