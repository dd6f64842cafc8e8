#include "vision/tracking/edge_line.hpp"

#include <Eigen/LU>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "vision/tracking/edge_fit.hpp"

namespace rift::vision {
namespace {

using Points = std::vector<Eigen::Vector2d>;

/// `count` points from `from` to `to`, alternately `off_px` to the one side and to the other.
Points Along(const Eigen::Vector2d& from, const Eigen::Vector2d& to, int count, double off_px) {
  const Eigen::Vector2d way = (to - from).normalized(), aside(-way.y(), way.x());
  Points points;
  for (int i = 0; i < count; ++i) {
    const double share = static_cast<double>(i) / (count - 1);
    points.emplace_back(from + share * (to - from) + (i % 2 == 0 ? off_px : -off_px) * aside);
  }
  return points;
}

TEST_CASE("Points on a line give that line, whichever way it runs") {
  const double angle = GENERATE(0.0, 0.4, 1.2, M_PI_2, 2.5, -0.9);
  const Eigen::Vector2d way(std::cos(angle), std::sin(angle)), at(30.0, -12.0);
  const auto line = FitLine(Along(at - 5.0 * way, at + 5.0 * way, 11, 0.0), 0.1);
  REQUIRE(line);
  CHECK(line->normal.norm() == Approx(1.0));
  CHECK(std::abs(line->normal.dot(way)) < 1e-9);
  CHECK((line->middle - at).norm() < 1e-9);
  CHECK(line->offset == Approx(line->normal.dot(at)));
  CHECK(line->count == 11);
  CHECK(line->length2 == Approx(2.0 * (25.0 + 16.0 + 9.0 + 4.0 + 1.0)));
  CHECK(line->rms < 1e-9);
  CHECK(line->Distance(at + 2.0 * line->normal) == Approx(2.0));
  CHECK(line->Distance(at - 2.0 * line->normal) == Approx(-2.0));
}

TEST_CASE("The scatter of a line is the root of the mean squared distance") {
  const auto line = FitLine(Along({0.0, 7.0}, {100.0, 7.0}, 101, 0.2), 0.1);
  REQUIRE(line);
  CHECK(line->rms == Approx(0.2).epsilon(0.01));
}

TEST_CASE("Points beyond three sigma are left out, and those within are not") {
  Points points = Along({0.0, 0.0}, {20.0, 0.0}, 21, 0.0);
  const double off_px = GENERATE(0.28, 0.6, 5.0);
  points[7].y() = off_px;
  const auto line = FitLine(points, 0.1);  // the limit is 0.3 px
  REQUIRE(line);
  CHECK(line->count == (off_px < 0.3 ? 21 : 20));
  CHECK((line->rms > 0.01) == (off_px < 0.3));
}

TEST_CASE("A point that is far off does not hide another one from being left out") {
  Points points = Along({0.0, 0.0}, {20.0, 0.0}, 21, 0.05);
  points[10].y() = 0.5;
  points[20].y() = 3.0;  // the line through all leans towards it
  const auto line = FitLine(points, 0.05);
  REQUIRE(line);
  CHECK(line->count == 19);
  CHECK(line->rms < 0.06);
}

TEST_CASE("However much its points scatter, half of them at least are kept") {
  // Four points of each size, to either side of the line at both ends: 4 px, 2.7 px and so on.
  Points points{{0.0, 0.0}};
  double off_px = 4.0;
  for (int i = 1; i <= 20; ++i, off_px /= 1.5) {
    for (const double x : {-1.0 * i, 1.0 * i}) {
      for (const double y : {-off_px, off_px}) points.emplace_back(x, y);
    }
  }
  const auto line = FitLine(points, 1e-6);
  REQUIRE(line);
  CHECK(line->count >= 41);
  CHECK(line->count < 61);
}

TEST_CASE("Points are left out in three rounds at most") {
  // Each round leaves out one more of these: 6, 4, 3 and 0.6 px off the line that the others lie
  // about.
  Points points = Along({0.0, 0.0}, {20.0, 0.0}, 21, 0.05);
  points[6].y() = 6.0;
  points[20].y() = 4.0;
  points[18].y() = 3.0;
  points[9].y() = 0.6;
  const auto line = FitLine(points, 0.05);
  REQUIRE(line);
  CHECK(line->count == 18);
}

TEST_CASE("A line wants four points") {
  CHECK_FALSE(FitLine(Along({0.0, 0.0}, {9.0, 0.0}, 3, 0.0), 0.1));
  CHECK(FitLine(Along({0.0, 0.0}, {9.0, 0.0}, 4, 0.0), 0.1));
}

TEST_CASE("Two lines meet in one point, unless they are all but parallel") {
  const EdgeLine level{.normal = {0.0, 1.0}, .offset = 3.0};
  const EdgeLine upright{.normal = {1.0, 0.0}, .offset = -2.0};
  CHECK((*Meet(level, upright) - Eigen::Vector2d(-2.0, 3.0)).norm() < 1e-12);
  CHECK((*Meet(upright, level) - Eigen::Vector2d(-2.0, 3.0)).norm() < 1e-12);
  const EdgeLine slanted{.normal = {std::sin(0.2), std::cos(0.2)}, .offset = 1.0};
  const auto met = Meet(level, slanted);
  REQUIRE(met);
  CHECK(std::abs(level.Distance(*met)) < 1e-12);
  CHECK(std::abs(slanted.Distance(*met)) < 1e-12);
  const EdgeLine nearly{.normal = {std::sin(0.09), std::cos(0.09)}, .offset = 1.0};
  CHECK_FALSE(Meet(level, nearly));
  CHECK_FALSE(Meet(nearly, level));
}

TEST_CASE("All but a cell at each end of a side is measured, at six points at least") {
  CHECK(MeasuredLength_px(80.0, 8) == Approx(60.0));
  CHECK(MeasuredLength_px(80.0, 5) == Approx(48.0));
  CHECK(PointCount(80.0, 8, 1.0) == 60);
  CHECK(PointCount(80.0, 8, 3.0) == 20);
  CHECK(PointCount(9.0, 8, 1.0) == 6);
  CHECK(PointCount(9.5, 8, 1.0) == 7);
}

/// A long-sided quadrangle with its corners in order, and points on its sides.
struct Quadrangle {
  std::array<Eigen::Vector2d, 4> corners{{{0.0, 40.0}, {70.0, 48.0}, {64.0, -3.0}, {5.0, 4.0}}};
  std::array<int, 4> counts{40, 25, 60, 30};

  std::array<EdgeLine, 4> Sides(double sigma_px, std::mt19937_64& random) const {
    std::normal_distribution<double> noise(0.0, sigma_px);
    std::array<EdgeLine, 4> sides;
    for (int i = 0; i < 4; ++i) {
      Points points = Along(corners[i], corners[(i + 1) % 4], counts[i], 0.0);
      const Eigen::Vector2d way = (corners[(i + 1) % 4] - corners[i]).normalized();
      for (Eigen::Vector2d& p : points) p += noise(random) * Eigen::Vector2d(-way.y(), way.x());
      sides[i] = *FitLine(points, 1.0);  // none is left out
    }
    return sides;
  }
};

TEST_CASE("The covariance of the corners is their scatter over many noisy edges") {
  const Quadrangle quadrangle;
  std::mt19937_64 random(5);
  CornerCovariance scatter = CornerCovariance::Zero(), said = CornerCovariance::Zero();
  constexpr int kRuns = 4000;
  for (int run = 0; run < kRuns; ++run) {
    const std::array<EdgeLine, 4> sides = quadrangle.Sides(0.1, random);
    Eigen::Matrix<double, 8, 1> error;
    for (int i = 0; i < 4; ++i) {
      error.segment<2>(2 * i) = *Meet(sides[(i + 3) % 4], sides[i]) - quadrangle.corners[i];
    }
    scatter += error * error.transpose() / kRuns;
    said += CovarianceOf(sides, quadrangle.corners, {.cells = 8}) / kRuns;
  }
  // Points that share their pixels count for less: 1.5 (see the code); here they share none.
  const CornerCovariance expected = 1.5 * scatter;
  for (int i = 0; i < 8; ++i) {
    CHECK(said(i, i) == Approx(expected(i, i)).epsilon(0.1));
    for (int k = 0; k < 8; ++k) {
      const double size = std::sqrt(expected(i, i) * expected(k, k));
      INFO("entry " << i << ", " << k);
      CHECK(std::abs(said(i, k) - expected(i, k)) < 0.1 * size);
    }
  }
}

TEST_CASE(
    "A corner is known as well as the two lines that meet in it, from what their points say") {
  // A square of 20 by 20 px with (0, 20) first, each side with its own number of points.
  const std::array<Eigen::Vector2d, 4> corners{
      {{0.0, 20.0}, {20.0, 20.0}, {20.0, 0.0}, {0.0, 0.0}}};
  const std::array<int, 4> counts{5, 6, 7, 8};
  std::array<EdgeLine, 4> sides;
  for (int i = 0; i < 4; ++i) {
    sides[i].normal = i % 2 == 0 ? Eigen::Vector2d(0.0, 1.0) : Eigen::Vector2d(1.0, 0.0);
    sides[i].middle = 0.5 * (corners[i] + corners[(i + 1) % 4]);
    sides[i].count = counts[i];
    sides[i].length2 = 100.0 + 50.0 * i;
    sides[i].rms = 0.1 * (i + 1);
  }
  const CornerCovariance said = CovarianceOf(sides, corners, {.cells = 8});
  // One scatter of all points: each line takes two from what they could show.
  const double point = (5 * 0.01 + 6 * 0.04 + 7 * 0.09 + 8 * 0.16) / (5 + 6 + 7 + 8 - 8);
  for (int i = 0; i < 4; ++i) {
    const int before = (i + 3) % 4;
    const auto variance = [&](int side) {
      return 1.5 * point * (1.0 / counts[side] + 100.0 / sides[side].length2);
    };
    const int level = i % 2 == 0 ? i : before, upright = i % 2 == 0 ? before : i;
    CHECK(said(2 * i, 2 * i) == Approx(variance(upright)));
    CHECK(said(2 * i + 1, 2 * i + 1) == Approx(variance(level)));
    CHECK(said(2 * i, 2 * i + 1) == Approx(0.0).margin(1e-15));
  }
  // The ends of one side share its offset, and its turn takes them to opposite sides.
  CHECK(said(1, 3) == Approx(1.5 * point * (1.0 / 5 - 100.0 / sides[0].length2)));
  CHECK(said(0, 4) == Approx(0.0).margin(1e-15));
}

TEST_CASE("What does not scatter is added to each corner, and to all of them together") {
  const Quadrangle quadrangle;
  std::mt19937_64 random(5);
  const std::array<EdgeLine, 4> sides = quadrangle.Sides(0.1, random);
  const CornerCovariance plain = CovarianceOf(sides, quadrangle.corners, {.cells = 8});
  const CornerCovariance each =
      CovarianceOf(sides, quadrangle.corners, {.corner_px = 0.3, .cells = 8}) - plain;
  CHECK((each - 0.09 * CornerCovariance::Identity()).norm() < 1e-12);
  const CornerCovariance all =
      CovarianceOf(sides, quadrangle.corners, {.shared_px = 0.4, .cells = 8}) - plain;
  // The shortest side has hypot(5, 36) px; of eight cells, 2.5 px each would be 20.
  const double sigma_px = 0.4 * std::pow(20.0 / std::hypot(5.0, 36.0), 3);
  for (int i = 0; i < 8; ++i) {
    for (int k = 0; k < 8; ++k) {
      INFO("entry " << i << ", " << k);
      CHECK(all(i, k) == Approx((i + k) % 2 == 0 ? sigma_px * sigma_px : 0.0).margin(1e-12));
    }
  }
}

}  // namespace
}  // namespace rift::vision
