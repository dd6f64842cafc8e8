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

TEST_CASE("The nearest point of a path lies on a leg of it or where two meet") {
  const std::vector<Eigen::Vector2d> path{{0.0, 0.0}, {1.0, 0.0}, {1.0, 0.0}, {1.0, 1.0}};
  const auto is_at = [&](const Eigen::Vector2d& p, const Eigen::Vector2d& nearest) {
    return (NearestOnPath(p, path) - nearest).norm() < 1e-12;
  };
  CHECK(is_at({0.1, 0.05}, {0.1, 0.0}));
  CHECK(is_at({0.5, -0.03}, {0.5, 0.0}));
  CHECK(is_at({1.2, 0.6}, {1.0, 0.6}));
  CHECK(is_at({1.2, -0.3}, {1.0, 0.0}));
}

TEST_CASE("Before a path, beyond it and on a leg without length the distance is to its point") {
  const std::vector<Eigen::Vector2d> path{{0.0, 0.0}, {0.0, 0.0}, {0.0, 2.0}};
  CHECK(PathOffset_m({-0.3, -0.4}, path) == Approx(0.5));
  CHECK(PathOffset_m({0.3, 2.4}, path) == Approx(-0.5));
  CHECK(PathOffset_m({-0.1, 1.0}, path) == Approx(0.1));
  // Beyond the tip of a hairpin both legs end: the side is that of the first.
  CHECK(PathOffset_m({1.05, 0.01}, {{0.0, 0.0}, {1.0, 0.0}, {0.0, 0.1}}) ==
        Approx(std::hypot(0.05, 0.01)));
  CHECK(OffsetText(0.0) == "0.0 mm left");
  CHECK(OffsetText(INFINITY) == "-");
}

}  // namespace
}  // namespace rift::view
