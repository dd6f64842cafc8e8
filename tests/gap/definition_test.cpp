#include "rift/gap/comparison.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <initializer_list>
#include <random>
#include <stdexcept>
#include <vector>

#include "support/inputs/paths.hpp"

namespace rift::gap {
namespace {

using test::Moved;
using test::RandomPath;
using test::StraightPath;
using trajectory::Trajectory;

struct Point {
  double x_m, y_m;
};

/// The point at share u of the length, straight from the rows.
Point PointAt(const Trajectory& path, double u) {
  std::vector<double> s_m{0.0};
  for (size_t i = 1; i < path.poses.size(); ++i) {
    const auto &a = path.poses[i - 1], &b = path.poses[i];
    s_m.push_back(s_m.back() + std::hypot(b.x_m - a.x_m, b.y_m - a.y_m));
  }
  const double wanted_m = u * s_m.back();
  size_t i = 1;
  while (i + 1 < s_m.size() && s_m[i] < wanted_m) ++i;
  const auto &a = path.poses[i - 1], &b = path.poses[i];
  const double share = s_m[i] > s_m[i - 1] ? (wanted_m - s_m[i - 1]) / (s_m[i] - s_m[i - 1]) : 0.0;
  return {a.x_m + share * (b.x_m - a.x_m), a.y_m + share * (b.y_m - a.y_m)};
}

/// The definition of section 3.1, written out as the paper does, for every sample.
double GapByDefinition(const Trajectory& sim, const Trajectory& real, int samples, int skipped) {
  double gap_m = 0.0;
  for (int k = skipped; k < samples; ++k) {
    const double u = static_cast<double>(k) / (samples - 1);
    const Point p = PointAt(sim, u), q = PointAt(real, u);
    gap_m = std::max(gap_m, std::hypot(p.x_m - q.x_m, p.y_m - q.y_m));
  }
  return gap_m;
}

Trajectory Through(std::initializer_list<Point> points) {
  Trajectory path;
  for (const Point& p : points) {
    path.poses.push_back(
        {.t_s = static_cast<double>(path.poses.size()), .x_m = p.x_m, .y_m = p.y_m});
  }
  return path;
}

TEST_CASE("The gap is that of the definition for any path and number of samples") {
  std::mt19937_64 generator(2);
  for (int i = 0; i < 100; ++i) {
    const Trajectory sim = RandomPath(generator, 3 + i), real = RandomPath(generator, 90);
    GapOptions options;
    options.samples = 10 * (1 + static_cast<int>(generator() % 60));
    options.skip_start = i % 2 == 0 ? 0.1 : 0.0;
    options.align = static_cast<Align>(i % 3);
    const int skipped = i % 2 == 0 ? options.samples / 10 : 0;
    Trajectory moved = sim;
    if (options.align == Align::kStart) {
      const auto &from = sim.poses[0], &to = real.poses[0];
      moved = Moved(sim, {to.x_m - from.x_m, to.y_m - from.y_m, 0.0});
    }
    if (options.align == Align::kSe2) {
      GapOptions unaligned = options;
      unaligned.align = Align::kNone;
      moved = Moved(sim, Compare(sim, real, unaligned).real_from_sim);
    }
    const double expected_m = GapByDefinition(moved, real, options.samples, skipped);
    CHECK(Gap(sim, real, options) == Approx(expected_m).margin(1e-13));
  }
}

TEST_CASE("The errors of a corner against a straight line are those worked out by hand") {
  // Both are 2 m long and part at the corner: sqrt(2) (s - 1) from there on.
  const Trajectory corner = Through({{0, 0}, {1, 0}, {1, 1}}), line = Through({{0, 0}, {2, 0}});
  const double root = std::sqrt(2.0);
  GapOptions options;
  options.samples = 5;  // errors 0, 0, 0, root / 2, root
  const Comparison result = Compare(corner, line, options);
  CHECK(result.gap_m == Approx(root));
  CHECK(result.gap_u == 1.0);
  CHECK(result.exact_gap_m == Approx(root));
  CHECK(result.mean_error_m == Approx(0.3 * root));
  CHECK(result.rms_error_m == Approx(std::sqrt(0.5)));
  CHECK(result.median_error_m == Approx(0.0).margin(1e-12));
  CHECK(result.p95_error_m == Approx(0.9 * root));
  CHECK(result.end_error_m == Approx(root));
  CHECK(result.hausdorff_m == Approx(1.0));
  options.skip_start = 0.4;
  CHECK(Compare(corner, line, options).mean_error_m == Approx(root / 2.0));
}

TEST_CASE("An error before the last bend is found where it stands") {
  // A tooth of 0.5 m base and 0.5 m legs: its tip stands at s = 1 of 2, over x = 0.75.
  const Trajectory tooth = Through({{0, 0}, {0.5, 0}, {0.75, std::sqrt(3) / 4}, {1, 0}, {1.5, 0}});
  const Comparison result = Compare(tooth, Through({{0, 0}, {1.5, 0}}), {});
  CHECK(result.exact_gap_m == Approx(std::sqrt(3) / 4));
  CHECK(result.exact_gap_u == Approx(0.5));
  CHECK(result.gap_u == Approx(0.5).margin(1.0 / 1999));
}

TEST_CASE("The samples left out are a share of all without loss by rounding") {
  const Trajectory path = StraightPath(1.0, 5);
  const auto first_u = [&](int samples, double skip_start) {
    GapOptions options;
    options.samples = samples;
    options.skip_start = skip_start;
    const ErrorProfile profile = ProfileAlong(path, path, options);
    CHECK(profile.u.back() == 1.0);
    return profile.u.front();
  };
  CHECK(first_u(100, 0.29) == 29.0 / 99.0);  // 0.29 * 100 is 28.999999999999996
  CHECK(first_u(2000, 0.1) == 200.0 / 1999.0);
  CHECK(first_u(2000, 0.0) == 0.0);
  CHECK(first_u(2, 0.95) == 1.0);
}

}  // namespace
}  // namespace rift::gap
