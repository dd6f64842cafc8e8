// Where spaces, samplers and runs end: sizes and limits on both of their sides.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <set>

#include "rift/search/options.hpp"
#include "search/cma_es.hpp"

namespace rift::search {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kMost = 4503599627370496.0;  // 2^52

TEST_CASE("Integers go up to 2^52 of either sign, and points are counted up to 2^53") {
  const auto integer = [](double min, double max) {
    return Space({{"n", AxisKind::kInteger, min, max}});
  };
  CHECK_NOTHROW(integer(0, kMost));
  CHECK_NOTHROW(integer(-kMost, 0));
  CHECK_THROWS_WITH(integer(0, kMost + 1.0),
                    "search: axis n from 0 to 4503599627370497: integers must stay below 2^52");
  CHECK_THROWS_WITH(integer(-kMost - 1.0, 0), Catch::Contains("integers must stay below 2^52"));
  CHECK_THROWS_WITH(integer(0.5, 2.0),
                    "search: axis n from 0.5 to 2: the bounds of integers and categories must be "
                    "whole");
  CHECK_THROWS_WITH(integer(-kInfinity, 2.0),
                    "search: axis n from -inf to 2: the bounds must be finite");
  CHECK_THROWS_WITH(integer(3.0, 2.0),
                    "search: axis n from 3 to 2: the lower bound must not exceed the upper one");
  CHECK_THROWS_WITH(Space({{"c", AxisKind::kCategorical, -1.0, 2.0}}),
                    "search: axis c from -1 to 2: categories count from 0");
  const auto points = [](double levels, double others) {
    return Space({{"n", AxisKind::kInteger, 1, levels}, {"m", AxisKind::kInteger, 1, others}})
        .Points();
  };
  CHECK(points(67108864.0, 134217728.0) == 9007199254740992u);  // 2^26 * 2^27
  CHECK_FALSE(points(67108865.0, 134217728.0));
  CHECK(points(1.0, 1.0) == 1u);
}

TEST_CASE("Points keep their levels apart by less than a cell, whatever the cells") {
  const Space space({{"n", AxisKind::kInteger, 0, 1e6}, {"x", AxisKind::kContinuous, 0.0, 1.0}});
  const Eigen::VectorXd one = space.ToUnit({500'000.0, 0.3});
  CHECK(space.HaveSameLevels(one, space.ToUnit({500'000.0, 0.9})));
  CHECK_FALSE(space.HaveSameLevels(one, space.ToUnit({500'001.0, 0.3})));
  CHECK_FALSE(space.HaveSameLevels(one, space.ToUnit({499'999.0, 0.3})));
}

TEST_CASE("A Latin hypercube has as many strata as points, and ten thousand at most") {
  for (const auto& [budget, strata] : {std::pair{50, 50}, {10'000, 10'000}, {30'000, 10'000}}) {
    SearchOptions options;
    options.strategy = Method::kLatinHypercube;
    options.batch = 10'000;
    const auto strategy =
        MakeStrategy(options, {{"a", AxisKind::kContinuous, 0.0, 1.0}}, budget, 3);
    std::set<int> hit;
    for (const Point& point : strategy->Ask(strata)) {
      hit.insert(static_cast<int>(point[0] * strata));
    }
    CAPTURE(budget);
    CHECK(hit.size() == static_cast<std::size_t>(strata));
  }
}

/// A generation whose losses are `from` and more, in proportion to the place; the least and the
/// distance from there to the largest.
std::pair<double, double> Learn(CmaEs& search, statistics::Random& random, double from,
                                double slope) {
  std::vector<double> losses;
  for (const Eigen::VectorXd& unit : search.Sample(random)) {
    losses.push_back(from + slope * unit[0]);
  }
  search.Learn(losses);
  const auto [least, most] = std::minmax_element(losses.begin(), losses.end());
  return {*least, *most - *least};
}

TEST_CASE("A run is hopeless a hundred times its generation's spread behind the best known") {
  const Space space({{"a", AxisKind::kContinuous, 0.0, 1.0}});
  statistics::Random random(8, 1);
  CmaEs search(space, Eigen::VectorXd::Constant(1, 0.5), 0.05, 8);
  const auto [best, spread] = Learn(search, random, 1.0, 1.0);
  CHECK_FALSE(search.IsDone(kInfinity));
  CHECK_FALSE(search.IsDone(best - 99.0 * spread));
  CHECK(search.IsDone(best - 101.0 * spread));
}

TEST_CASE("Equal losses end a run of ranges alone, and other spaces after their patience") {
  statistics::Random random(8, 1);
  const auto generations = [&random](const std::vector<Axis>& axes) {
    const Space space(axes);
    CmaEs search(space, Eigen::VectorXd::Constant(space.Size(), 0.5), 0.2, 8);
    int count = 0;
    do {
      Learn(search, random, 3.0, 0.0);
      ++count;
    } while (count < 100 && !search.IsDone(3.0));
    return count;
  };
  const Axis range{"x", AxisKind::kContinuous, 0.0, 1.0}, whole{"n", AxisKind::kInteger, 0, 50},
      word{"w", AxisKind::kCategorical, 0, 5};
  CHECK(generations({range}) == 1);
  CHECK(generations({word, range}) == 1);
  // Of 20 generations and 80 evaluations an axis, after the first.
  CHECK(generations({word}) == 1 + 20 + 80 / 8);
  CHECK(generations({word, word}) == 1 + 20 + 160 / 8);
  CHECK(generations({whole}) > 1);
}

TEST_CASE("Runs of doubling populations and of small ones share the evaluations, to 2^9 times") {
  Known known(std::vector<Axis>(2, {"a", AxisKind::kContinuous, 0.0, 1.0}));
  Restarts search(known, 1, 3);
  double large = 0.0, small = 0.0;
  int doublings = 0, at_most = 0;
  for (int run = 0; at_most < 3; ++run) {
    const std::vector<Point> points = search.Ask(1'000'000);
    std::vector<Evaluation> batch;
    for (const Point& point : points) batch.push_back({point, 1.0});  // a run of one generation
    search.Tell(batch);
    REQUIRE(search.IsBetweenRuns());
    const auto size = static_cast<double>(points.size());
    CAPTURE(run, size, large, small);
    if (run == 0 || large <= small) {
      if (run > 0) doublings = std::min(doublings + 1, 9);
      REQUIRE(size == 6.0 * std::pow(2.0, doublings));
      large += size;
      at_most += doublings == 9;
    } else {
      REQUIRE(size >= 4.0);
      REQUIRE(size <= std::max(6.0, 3.0 * std::pow(2.0, doublings)));
      small += size;
    }
  }
  CHECK(small / large == Approx(1.0).margin(0.5));
}

}  // namespace
}  // namespace rift::search
