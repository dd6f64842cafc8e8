// The parts of the strategies, each against what it must be by hand.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <set>

#include "rift/search/options.hpp"
#include "search/archive.hpp"
#include "search/cma_es.hpp"
#include "search/controlled_random_search.hpp"
#include "search/differential_evolution.hpp"
#include "search/local_model.hpp"
#include "search/samplers.hpp"
#include "search/scalar_cma.hpp"
#include "search/surrogate.hpp"

namespace rift::search {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr int kPopulation = 6;  ///< of CMA-ES

const std::vector<Axis> kMixed{{"x", AxisKind::kContinuous, -2.0, 6.0},
                               {"n", AxisKind::kInteger, -1, 2},
                               {"w", AxisKind::kCategorical, 0, 2}};

Eigen::VectorXd Unit(std::initializer_list<double> values) {
  Eigen::VectorXd unit(static_cast<Eigen::Index>(values.size()));
  std::copy(values.begin(), values.end(), unit.begin());
  return unit;
}

TEST_CASE(
    "A unit cube holds each axis: ranges evenly, levels in equal cells, beyond it the bounds") {
  const Space space(kMixed);
  CHECK(space.FromUnit(Unit({0.0, 0.0, 0.0})) == Point{-2.0, -1.0, 0.0});
  CHECK(space.FromUnit(Unit({1.0, 1.0, 1.0})) == Point{6.0, 2.0, 2.0});
  CHECK(space.FromUnit(Unit({0.25, 0.25, 0.33})) == Point{0.0, 0.0, 0.0});
  CHECK(space.FromUnit(Unit({0.5, 0.2499, 0.34})) == Point{2.0, -1.0, 1.0});
  CHECK(space.FromUnit(Unit({-3.0, -3.0, -3.0})) == Point{-2.0, -1.0, 0.0});
  CHECK(space.FromUnit(Unit({7.0, 7.0, 7.0})) == Point{6.0, 2.0, 2.0});
  const Eigen::VectorXd unit = space.ToUnit({4.0, 1.0, 1.0});
  CHECK(unit[0] == Approx(0.75));
  CHECK(unit[1] == Approx(2.5 / 4.0));
  CHECK(unit[2] == Approx(0.5));
  CHECK(space.Size() == 3);
  CHECK(space.ContinuousAxes() == std::vector<int>{0});
  CHECK(space.DiscreteAxes() == std::vector<int>{1, 2});
  CHECK(space.Levels(0) == 0.0);
  CHECK(space.Levels(1) == 4.0);
  CHECK(space.Levels(2) == 3.0);
  CHECK(space.IsCategorical(2));
  CHECK_FALSE(space.IsCategorical(1));
  CHECK(space.HaveSameLevels(space.ToUnit({1.0, 1.0, 1.0}), space.ToUnit({5.0, 1.0, 1.0})));
  CHECK_FALSE(space.HaveSameLevels(space.ToUnit({1.0, 1.0, 1.0}), space.ToUnit({1.0, 0.0, 1.0})));
  CHECK_FALSE(space.HaveSameLevels(space.ToUnit({1.0, 1.0, 1.0}), space.ToUnit({1.0, 1.0, 2.0})));
  CHECK_FALSE(space.Points());
}

TEST_CASE("Points of a finite space are counted, and each has an index") {
  const Space space({kMixed[1], kMixed[2]});
  REQUIRE(space.Points());
  CHECK(*space.Points() == 12);
  std::set<Point> points;
  for (std::uint64_t i = 0; i < 12; ++i) points.insert(space.AtIndex(i));
  CHECK(points.size() == 12);
  CHECK(space.AtIndex(0) == Point{-1.0, 0.0});
  CHECK(space.AtIndex(1) == Point{0.0, 0.0});
  CHECK(space.AtIndex(4) == Point{-1.0, 1.0});
  CHECK(space.AtIndex(11) == Point{2.0, 2.0});
  const Space fixed({{"f", AxisKind::kContinuous, 2.5, 2.5}, kMixed[2]});
  CHECK(*fixed.Points() == 3);
  CHECK(fixed.Levels(0) == 1.0);
  CHECK(fixed.AtIndex(2) == Point{2.5, 2.0});
  CHECK_THROWS_WITH(Space({{"n", AxisKind::kInteger, 0, 5e15}}), Catch::Contains("below 2^52"));
  CHECK_THROWS_WITH(Space({{"n", AxisKind::kInteger, 0, 1.5}}), Catch::Contains("must be whole"));
  CHECK_THROWS_WITH(Space({{"x", AxisKind::kContinuous, 0.0, kInfinity}}),
                    Catch::Contains("finite"));
  CHECK_NOTHROW(Space({{"n", AxisKind::kInteger, -5, 3}}));
}

TEST_CASE("The best evaluations stand by their loss, the earlier first, none as the worst") {
  Archive archive;
  CHECK(archive.IsEmpty());
  CHECK(archive.BestLoss() == kInfinity);
  archive.Add({{1.0}, 5.0});
  archive.Add({{2.0}, std::numeric_limits<double>::quiet_NaN()});
  archive.Add({{3.0}, 2.0});
  archive.Add({{4.0}, 5.0});
  archive.Add({{0.0}, -kInfinity});
  CHECK(archive.Size() == 5);
  CHECK(archive.Best(9) == std::vector<std::size_t>{2, 0, 3, 1, 4});
  CHECK(archive.Best(2) == std::vector<std::size_t>{2, 0});
  CHECK(archive.Best(0).empty());
  CHECK(archive.BestLoss() == 2.0);
  CHECK(archive[1].loss == kInfinity);
  CHECK(archive[4].loss == kInfinity);
  CHECK(archive.Find({4.0}) == 3u);
  CHECK(archive.Find({-0.0}) == 4u);
  CHECK_FALSE(archive.Find({5.0}));
  archive.Add({{9.0}, -1.0});
  CHECK(archive.BestLoss() == -1.0);
}

/// In how many of the `cells` equal parts of an axis the points lie.
template <class Place>
int CellsHit(const std::vector<Eigen::VectorXd>& points, const Place& place) {
  std::set<int> cells;
  for (const Eigen::VectorXd& point : points) cells.insert(place(point));
  return static_cast<int>(cells.size());
}

TEST_CASE("Corners are the bounds of every axis with each category, of a fixed one its value") {
  const Axis range{"a", AxisKind::kContinuous, -1.0, 2.0}, whole{"n", AxisKind::kInteger, 3, 9},
      words{"w", AxisKind::kCategorical, 0, 4}, fixed{"f", AxisKind::kContinuous, 2.5, 2.5};
  CHECK(Space({range}).Corners() == 2.0);
  CHECK(Space({words}).Corners() == 5.0);
  CHECK(Space({fixed}).Corners() == 1.0);
  CHECK(Space({range, whole, words, fixed}).Corners() == 20.0);
}

TEST_CASE("Scrambled Sobol points keep the net: one in each interval and each elementary box") {
  for (const std::uint64_t seed : {1, 2, 3}) {
    SobolSequence sequence(3, seed);
    for (int i = 1; i < 16; ++i) sequence.Next();  // its first point is number 1, not 0
    for (int block = 0; block < 4; ++block) {
      std::vector<Eigen::VectorXd> points;
      for (int i = 0; i < 16; ++i) points.push_back(sequence.Next());
      for (int axis = 0; axis < 3; ++axis) {
        CHECK(CellsHit(points, [&](const auto& p) { return static_cast<int>(16.0 * p[axis]); }) ==
              16);
      }
      for (const auto& [rows, columns] : {std::pair{4, 4}, {2, 8}, {8, 2}}) {
        CHECK(CellsHit(points, [&, r = rows, c = columns](const auto& p) {
                return static_cast<int>(r * p[0]) * c + static_cast<int>(c * p[1]);
              }) == 16);
      }
    }
  }
  CHECK((SobolSequence(2, 1).Next() - SobolSequence(2, 2).Next()).norm() > 1e-6);
  CHECK(SobolSequence(2, 1).Next() == SobolSequence(2, 1).Next());
}

TEST_CASE("Random points are even and independent from one to the next") {
  const Space space(std::vector<Axis>(2, {"a", AxisKind::kContinuous, 0.0, 1.0}));
  RandomSampler sampler(space, 5);
  double sum = 0.0, squares = 0.0, next = 0.0, across = 0.0, last = 0.5;
  constexpr int kPoints = 4000;
  for (const Point& p : sampler.Ask(kPoints)) {
    const double a = p[0] - 0.5;
    sum += a;
    squares += a * a;
    next += a * (last - 0.5);
    across += a * (p[1] - 0.5);
    last = p[0];
  }
  CHECK(std::abs(sum / kPoints) < 0.02);
  CHECK(squares / kPoints * 12.0 == Approx(1.0).margin(0.06));
  CHECK(std::abs(next / kPoints * 12.0) < 0.07);
  CHECK(std::abs(across / kPoints * 12.0) < 0.07);
}

TEST_CASE("One Latin hypercube follows the other, each with a shuffle of its own") {
  const Space space(std::vector<Axis>(2, {"a", AxisKind::kContinuous, 0.0, 1.0}));
  LatinHypercubeSampler sampler(space, 5, 10);
  std::vector<std::vector<int>> orders;
  for (int block = 0; block < 3; ++block) {
    std::set<int> strata[2];
    std::vector<int>& order = orders.emplace_back();
    for (const Point& p : sampler.Ask(10)) {
      for (const int axis : {0, 1}) {
        strata[axis].insert(static_cast<int>(10.0 * p[static_cast<size_t>(axis)]));
      }
      order.push_back(static_cast<int>(10.0 * p[0]));
    }
    CHECK(strata[0].size() == 10);
    CHECK(strata[1].size() == 10);
    CHECK_FALSE(std::is_sorted(order.begin(), order.end()));
  }
  CHECK(orders[0] != orders[1]);
  CHECK(orders[1] != orders[2]);
}

TEST_CASE("A stratum that is drawn first is any of them: the shuffle is even") {
  const Space space({{"a", AxisKind::kContinuous, 0.0, 1.0}});
  std::map<int, int> first, last;
  for (std::uint64_t seed = 0; seed < 2000; ++seed) {
    const std::vector<Point> points = LatinHypercubeSampler(space, seed, 4).Ask(4);
    ++first[static_cast<int>(4.0 * points[0][0])];
    ++last[static_cast<int>(4.0 * points[3][0])];
  }
  for (int stratum = 0; stratum < 4; ++stratum) {
    CHECK(first[stratum] == Approx(500).margin(90));  // 4.6 standard deviations
    CHECK(last[stratum] == Approx(500).margin(90));
  }
}

TEST_CASE("Some of many corners are balanced on every axis") {
  const Space space(std::vector<Axis>(10, {"a", AxisKind::kContinuous, -1.0, 1.0}));
  CornerSampler sampler(space, 3);
  std::vector<int> high(10, 0);
  for (const Point& p : sampler.Ask(64)) {
    for (size_t axis = 0; axis < 10; ++axis) high[axis] += p[axis] == 1.0;
  }
  for (const int count : high) CHECK(count == Approx(32).margin(2));
}

double Matern(double r) {
  const double x = std::sqrt(5.0) * r;
  return (1.0 + x + x * x / 3.0) * std::exp(-x);
}

TEST_CASE(
    "Kriging of two values is the textbook's, with lengths of a half and a hundredth of noise") {
  const Space space({{"a", AxisKind::kContinuous, 0.0, 1.0}, {"w", AxisKind::kCategorical, 0, 1}});
  statistics::Random random(1, 1);
  Kriging model(space);
  CHECK(model.Scale(0) == Approx(0.5));
  CHECK(model.Scale(1) == Approx(0.5));
  Eigen::MatrixXd points(2, 2), at(3, 2);
  points << 0.2, 0.25, 0.6, 0.25;
  at << 0.3, 0.25, 0.2, 0.25, 0.2, 0.75;
  model.Fit(points, Unit({1.0, -2.0}), 0, random);
  const Kriging::Prediction found = model.Predict(at);
  const double k = Matern(0.4 / 0.5), diagonal = 1.01, determinant = diagonal * diagonal - k * k;
  const double solved[] = {(diagonal * 1.0 - k * -2.0) / determinant,
                           (diagonal * -2.0 - k * 1.0) / determinant};
  const double signal = 0.5 * (1.0 * solved[0] - 2.0 * solved[1]);
  const double to[3][2] = {{Matern(0.1 / 0.5), Matern(0.3 / 0.5)},
                           {1.0, k},
                           // another level is a length scale's inverse away, beside the way on a
                           {Matern(2.0), Matern(std::hypot(0.8, 2.0))}};
  for (int i = 0; i < 3; ++i) {
    const double a = to[i][0], b = to[i][1];
    CHECK(found.mean[i] == Approx(a * solved[0] + b * solved[1]));
    const double explained = (diagonal * a * a - 2.0 * k * a * b + diagonal * b * b) / determinant;
    CHECK(found.variance[i] == Approx(signal * (1.0 - explained)));
  }
  const Eigen::VectorXd correlation = model.Correlation(at, Unit({0.3, 0.75}));
  CHECK(correlation[0] == Approx(Matern(2.0)));
  CHECK(correlation[1] == Approx(Matern(std::hypot(0.2, 2.0))));
  CHECK(correlation[2] == Approx(Matern(0.2)));
}

TEST_CASE("A fit of the scales tells an axis that matters from one that does not") {
  const Space space(std::vector<Axis>(2, {"a", AxisKind::kContinuous, 0.0, 1.0}));
  statistics::Random random(3, 1);
  Eigen::MatrixXd points(40, 2);
  Eigen::VectorXd values(40);
  SobolSequence sequence(2, 1);
  for (int i = 0; i < 40; ++i) {
    points.row(i) = sequence.Next();
    values[i] = std::sin(9.0 * points(i, 1));
  }
  Kriging model(space);
  model.Fit(points, values, 60, random);
  CHECK(model.Scale(0) > 2.0 * model.Scale(1));
  CHECK(model.Scale(1) > 0.02);
  CHECK(model.Scale(0) < 20.0);
  Eigen::MatrixXd at(1, 2);
  at << 0.37, 0.62;
  CHECK(model.Predict(at).mean[0] == Approx(std::sin(9.0 * 0.62)).margin(0.05));
}

TEST_CASE(
    "The surrogate proposes where a surface that it knows is least, and a batch is of several") {
  Known known({{"a", AxisKind::kContinuous, 0.0, 1.0}, {"b", AxisKind::kContinuous, 0.0, 1.0}});
  SobolSequence sequence(2, 9);
  for (int i = 0; i < 80; ++i) {
    const Eigen::VectorXd u = sequence.Next();
    known.archive.Add({{u[0], u[1]}, std::pow(u[0] - 0.7, 2) + 2.0 * std::pow(u[1] - 0.3, 2)});
  }
  Surrogate surrogate(known, 4);
  const std::vector<Point> points = surrogate.Ask(8);
  REQUIRE(points.size() == 8);
  int near = 0;
  for (const Point& p : points) near += std::hypot(p[0] - 0.7, p[1] - 0.3) < 0.15;
  CHECK(near >= 5);
  CHECK(std::set<Point>(points.begin(), points.end()).size() >= 6);
}

TEST_CASE("On one axis CMA-ES is Hansen's, generation by generation") {
  const Space space({{"a", AxisKind::kContinuous, 0.0, 1.0}});
  statistics::Random random(8, 1), same(8, 1);
  CmaEs search(space, Unit({0.45}), 0.02, kPopulation);
  ScalarCma by_hand(0.45, 0.02, kPopulation);
  for (int generation = 0; generation < 12; ++generation) {
    INFO("generation " << generation);
    std::vector<double> drawn, losses;
    for (const Eigen::VectorXd& unit : search.Sample(random)) {
      const double expected =
          by_hand.mean + by_hand.sigma * by_hand.length * std::abs(same.Normal());
      // An eigenvector has either sign.
      CHECK(std::abs(unit[0] - by_hand.mean) == Approx(expected - by_hand.mean).margin(1e-9));
      drawn.push_back(unit[0]);
      losses.push_back(std::abs(unit[0] - 0.5));
    }
    search.Learn(losses);
    std::sort(drawn.begin(), drawn.end(),
              [](double a, double b) { return std::abs(a - 0.5) < std::abs(b - 0.5); });
    by_hand.Learn(drawn);
  }
  CHECK(by_hand.mean == Approx(0.5).margin(0.02));
}

TEST_CASE("No spread of CMA-ES is wider than an axis") {
  const Space space({{"a", AxisKind::kContinuous, 0.0, 1.0}});
  statistics::Random random(8, 1), same(8, 1);
  CmaEs search(space, Unit({0.5}), 2.0, kPopulation);
  ScalarCma by_hand(0.5, 2.0, kPopulation);
  std::vector<double> drawn, losses;
  for (const Eigen::VectorXd& unit : search.Sample(random)) {
    same.Normal();
    drawn.push_back(unit[0]);
    losses.push_back(std::abs(unit[0] - 0.5));
  }
  search.Learn(losses);
  std::stable_sort(drawn.begin(), drawn.end(),
                   [](double a, double b) { return std::abs(a - 0.5) < std::abs(b - 0.5); });
  by_hand.Learn(drawn);
  int inside = 0;
  for (int generation = 0; generation < 4; ++generation) {  // more draws of the same spread
    for (const Eigen::VectorXd& unit : search.Sample(random)) {
      const double step = std::abs(same.Normal());
      if (unit[0] <= 0.0 || unit[0] >= 1.0) continue;
      CHECK(std::abs(unit[0] - by_hand.mean) == Approx(step).margin(1e-9));
      ++inside;
    }
  }
  CHECK(inside > 3);
}

TEST_CASE("Samples beyond a bound are moved onto it, at either end") {
  const Space space(std::vector<Axis>(2, {"a", AxisKind::kContinuous, 0.0, 1.0}));
  statistics::Random random(8, 1);
  CmaEs search(space, Unit({0.0, 1.0}), 0.25, 200);
  int low = 0, high = 0;
  for (const Eigen::VectorXd& unit : search.Sample(random)) {
    CHECK(unit.minCoeff() >= 0.0);
    CHECK(unit.maxCoeff() <= 1.0);
    low += unit[0] == 0.0;
    high += unit[1] == 1.0;
  }
  CHECK(low == Approx(100).margin(33));
  CHECK(high == Approx(100).margin(33));
}

TEST_CASE("Half of the first draws keep the level of the start, and none of them dies out") {
  const Space space({{"a", AxisKind::kContinuous, 0.0, 1.0}, {"w", AxisKind::kCategorical, 0, 3}});
  statistics::Random random(8, 1);
  CmaEs search(space, Unit({0.5, 0.6}), 0.1, 400);  // level 2
  const auto counts = [&] {
    std::map<int, int> levels;
    std::vector<double> losses;
    for (const Eigen::VectorXd& unit : search.Sample(random)) {
      const double level = unit[1] * 4.0 - 0.5;
      CHECK(level == Approx(std::round(level)));
      ++levels[static_cast<int>(std::lround(level))];
      losses.push_back(level == 1.0 ? 0.0 : 1.0);
    }
    search.Learn(losses);
    return levels;
  };
  std::map<int, int> levels = counts();
  CHECK(levels[2] == Approx(250).margin(45));  // a half and a quarter of the other half
  for (const int other : {0, 1, 3}) CHECK(levels[other] == Approx(50).margin(32));
  for (int i = 0; i < 30; ++i) levels = counts();
  CHECK(levels[1] > 250);  // which is the best
  for (const int other : {0, 2, 3}) CHECK(levels[other] == Approx(20 / 1.15).margin(18));
}

TEST_CASE("Integers keep reaching their neighbours however narrow the search has become") {
  const Space space({{"n", AxisKind::kInteger, 0, 9}});
  statistics::Random random(8, 1);
  CmaEs search(space, Unit({0.55}), 1e-4, 1000);  // the middle of 5
  std::map<int, int> values;
  for (const Eigen::VectorXd& unit : search.Sample(random)) {
    ++values[static_cast<int>(space.FromUnit(unit)[0])];
  }
  // The spread is 0.3 of a cell: each neighbour is 1.67 deviations away, a probability of 4.8 %.
  CHECK(values[5] == Approx(904).margin(45));
  CHECK(values[4] == Approx(48).margin(32));
  CHECK(values[6] == Approx(48).margin(32));
}

TEST_CASE("A run is done without progress, when flat, when narrow, or far behind another") {
  const Space space({{"a", AxisKind::kContinuous, 0.0, 1.0}});
  statistics::Random random(8, 1);
  const auto learn = [&](CmaEs& search, double from, double slope) {
    std::vector<double> losses;
    for (const Eigen::VectorXd& unit : search.Sample(random)) {
      losses.push_back(from + slope * unit[0]);
    }
    search.Learn(losses);
  };
  CmaEs flat(space, Unit({0.5}), 0.2, 6);
  learn(flat, 1.0, 0.0);
  CHECK(flat.IsDone(1.0));
  CmaEs slope(space, Unit({0.5}), 0.01, 6);
  learn(slope, 1.0, 1.0);
  CHECK_FALSE(slope.IsDone(0.9));
  CHECK(slope.IsDone(-100.0));  // a hundred times what its generation differs by
  CmaEs narrow(space, Unit({0.5}), 1e-8, 6);
  learn(narrow, 1.0, 1.0);
  CHECK(narrow.IsDone(1.0));
  CmaEs stuck(space, Unit({0.5}), 0.2, 8);
  learn(stuck, 0.0, 1.0);
  int generations = 0;
  while (generations < 100 && !stuck.IsDone(kInfinity)) {
    learn(stuck, 5.0, 0.01);  // worse than the first
    ++generations;
  }
  CHECK(generations == 20 + 80 / 8);
}

TEST_CASE("A run is narrow below 1e-7 of an axis, and flat below 1e-13 of its losses") {
  const Space space({{"a", AxisKind::kContinuous, 0.0, 1.0}});
  // One generation of a slope, and the spread that Hansen's equations leave of the first.
  const auto spread_after = [&](double sigma, bool& is_done) {
    statistics::Random random(8, 1);
    CmaEs search(space, Unit({0.5}), sigma, kPopulation);
    std::vector<double> drawn, losses;
    for (const Eigen::VectorXd& unit : search.Sample(random)) {
      drawn.push_back(unit[0]);
      losses.push_back(1e7 * (unit[0] - 0.5));
    }
    search.Learn(losses);
    is_done = search.IsDone(kInfinity);
    std::sort(drawn.begin(), drawn.end());
    ScalarCma by_hand(0.5, sigma, kPopulation);
    by_hand.Learn(drawn);
    return by_hand.sigma * std::sqrt(by_hand.covariance);
  };
  bool is_done = false;
  const double grows = spread_after(1e-7, is_done) / 1e-7;
  for (const double share : {0.96, 1.04}) {
    CHECK(spread_after(share * 1e-7 / grows, is_done) == Approx(share * 1e-7).epsilon(1e-4));
    CHECK(is_done == (share < 1.0));
    CmaEs search(space, Unit({0.5}), 0.1, kPopulation);
    statistics::Random random(8, 1);
    search.Sample(random);
    search.Learn({1000.0, 1000.0, 1000.0, 1000.0, 1000.0, 1000.0 + share * 1e-10});
    CHECK(search.IsDone(1000.0) == (share < 1.0));
  }
}

TEST_CASE("A loss counts as better from a part in 1e12 on") {
  const Space space({{"w", AxisKind::kCategorical, 0, 3}});
  const auto generations = [&](double better) {
    statistics::Random random(8, 1);
    CmaEs search(space, Unit({0.5}), 0.1, 8);
    int count = 0;
    do {
      search.Sample(random);
      const double best = count == 0 ? -1000.0 : -1000.0 * (1.0 + better);
      search.Learn(std::vector<double>{0.0, 0.0, 0.0, best, 0.0, 0.0, 0.0, 0.0});
      ++count;
    } while (count < 100 && !search.IsDone(kInfinity));
    return count;
  };
  // 20 generations and 80 evaluations, after the last that was better: the first or the second.
  CHECK(generations(0.96e-12) == 1 + 20 + 80 / 8);
  CHECK(generations(1.04e-12) == 2 + 20 + 80 / 8);
}

std::vector<Evaluation> Told(Strategy& strategy, int most, const auto& loss) {
  std::vector<Evaluation> batch;
  for (const Point& point : strategy.Ask(most)) batch.push_back({point, loss(point)});
  strategy.Tell(batch);
  return batch;
}

TEST_CASE("CMA-ES begins at the best point known, with a quarter of each axis as its spread") {
  Known known(std::vector<Axis>(2, {"a", AxisKind::kContinuous, 0.0, 10.0}));
  known.archive.Add({{2.0, 8.0}, 1.0});
  known.archive.Add({{9.0, 9.0}, 2.0});
  double sum_a = 0.0, sum_b = 0.0, n = 0.0;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    Restarts search(known, 1, seed);
    for (const Point& p : search.Ask(6)) sum_a += p[0], sum_b += p[1], n += 1.0;
  }
  CHECK(sum_a / n == Approx(2.0 + 0.45).margin(0.6));  // moved by the bound: 0.8 deviations away
  CHECK(sum_b / n == Approx(8.0 - 0.45).margin(0.6));
}

TEST_CASE("A generation is asked for in parts and learned from when it is whole") {
  Known known(std::vector<Axis>(2, {"a", AxisKind::kContinuous, 0.0, 1.0}));
  Restarts whole(known, 1, 3), parts(known, 1, 3);
  const auto loss = [](const Point& p) { return p[0] + p[1]; };
  std::vector<Point> at_once, in_parts;
  for (int generation = 0; generation < 3; ++generation) {
    for (const Evaluation& one : Told(whole, 6, loss)) at_once.push_back(one.point);
    for (const int most : {4, 1, 4}) {
      for (const Evaluation& one : Told(parts, most, loss)) in_parts.push_back(one.point);
    }
  }
  CHECK(at_once.size() == 18);  // 4 + 3 log 2 = 6 points
  CHECK(at_once == in_parts);
}

TEST_CASE("Populations are whole batches, nearest to what the method asks for") {
  Known known(std::vector<Axis>(4, {"a", AxisKind::kContinuous, 0.0, 1.0}));  // 8 by itself
  const auto generation = [&](int batch) { return Restarts(known, batch, 3).Ask(1000).size(); };
  CHECK(generation(1) == 8);
  CHECK(generation(3) == 9);
  CHECK(generation(5) == 10);
  CHECK(generation(8) == 8);
  CHECK(generation(20) == 8);  // less than a batch
}

TEST_CASE("Differential evolution goes half way to a bound that it would cross, and never beyond") {
  Known known(std::vector<Axis>(2, {"a", AxisKind::kContinuous, 0.0, 1.0}));
  DifferentialEvolution search(known, 3);
  int at_bound = 0, near = 0;
  for (int i = 0; i < 60; ++i) {
    const std::vector<Evaluation> batch =
        Told(search, 12, [](const Point& p) { return p[0] - p[1]; });  // the corner (0, 1)
    for (const Evaluation& one : batch) {
      CHECK(one.point[0] >= 0.0);
      CHECK(one.point[1] <= 1.0);
      at_bound += one.point[0] == 0.0 || one.point[1] == 1.0;
      if (i > 40) near += one.point[0] < 0.02 && one.point[1] > 0.98;
    }
  }
  CHECK(at_bound == 0);  // half of the way is never there
  CHECK(near > 60);      // of 228, where one point at random would be
}

TEST_CASE(
    "The first members of an evolution are the best known, and the rest anywhere, each tried") {
  Known known(std::vector<Axis>(2, {"a", AxisKind::kContinuous, 0.0, 1.0}));
  for (int i = 0; i < 30; ++i) known.archive.Add({{0.5 + 0.001 * i, 0.5}, 30.0 - i});
  DifferentialEvolution search(known, 3);
  // Twelve members: six known, six at random. Those known are varied at once.
  const std::vector<Evaluation> first = Told(search, 100, [](const Point&) { return 100.0; });
  REQUIRE(first.size() == 12);
  for (int i = 0; i < 6; ++i) CHECK(std::abs(first[static_cast<size_t>(i)].point[0] - 0.52) < 0.6);
  int far = 0;
  for (size_t i = 6; i < 12; ++i) far += std::abs(first[i].point[1] - 0.5) > 0.05;
  CHECK(far >= 4);
}

TEST_CASE("A reflection of two points through the best is where it must be") {
  Known known({{"a", AxisKind::kContinuous, 0.0, 1.0}});
  // One axis: the simplex is the best and one other, which is reflected through the best: 2 b - x.
  for (int i = 0; i < 20; ++i) {
    const double x = 0.4 + 0.01 * i;
    known.archive.Add({{x}, std::abs(x - 0.5)});
  }
  ControlledRandomSearch search(known, 3);
  std::set<double> expected;
  for (int i = 0; i < 20; ++i) expected.insert(1.0 - (0.4 + 0.01 * i));
  for (const Point& p : search.Ask(12)) {
    const auto is_one = [&](double x) { return std::abs(x - p[0]) < 1e-9; };
    CHECK(std::any_of(expected.begin(), expected.end(), is_one));
  }
}

TEST_CASE("A population within a millionth of every axis is used up, and draws anywhere again") {
  for (const double share : {0.95, 1.05}) {
    Known known({{"a", AxisKind::kContinuous, 0.0, 1.0}});
    for (int i = 0; i < 20; ++i) known.archive.Add({{0.5 + share * 1e-6 * i / 19.0}, 1.0 * i});
    ControlledRandomSearch search(known, 3);
    int far = 0;
    for (const Point& p : search.Ask(10)) far += std::abs(p[0] - 0.5) > 1e-5;
    CHECK(far == (share < 1.0 ? 10 : 0));
  }
}

TEST_CASE("Before there are three members a vertex controlled random search draws anywhere") {
  Known known({{"a", AxisKind::kContinuous, 0.0, 1.0}});
  ControlledRandomSearch search(known, 3);
  std::vector<Point> drawn;
  for (int i = 0; i < 6; ++i) {
    const std::vector<Point> points = search.Ask(1);
    drawn.push_back(points[0]);
    known.archive.Add({points[0], points[0][0]});
    search.Tell(std::vector<Evaluation>{{points[0], points[0][0]}});
  }
  double least = 1.0;
  for (const Point& p : drawn) least = std::min(least, p[0]);
  const double next = search.Ask(1)[0][0];  // 2 best - other, at most the bound
  const bool is_reflection =
      next == 0.0 || std::any_of(drawn.begin(), drawn.end(), [&](const Point& p) {
        return std::abs(2.0 * least - p[0] - next) < 1e-12;
      });
  CHECK(is_reflection);
}

TEST_CASE("A local run tries the integers and categories one step on before its model") {
  Known known(kMixed);
  known.archive.Add({{2.0, 0.0, 1.0}, 5.0});
  LocalModel search(known, 3);
  CHECK(search.IsBetweenRuns());
  const std::vector<Point> neighbours = search.Ask(10);
  CHECK_FALSE(search.IsBetweenRuns());
  REQUIRE(neighbours.size() == 3);
  CHECK(neighbours[0] == Point{2.0, -1.0, 1.0});
  CHECK(neighbours[1] == Point{2.0, 1.0, 1.0});
  CHECK(neighbours[2][1] == 0.0);
  CHECK(neighbours[2][2] != 1.0);
  search.Tell(
      std::vector<Evaluation>{{neighbours[0], 6.0}, {neighbours[1], 3.0}, {neighbours[2], 7.0}});
  const std::vector<Point> next = search.Ask(10);
  REQUIRE(next.size() == 1);
  CHECK(next[0][1] == 1.0);  // from the better level
  CHECK(next[0][2] == 1.0);
}

TEST_CASE(
    "At the end of an integer axis there is one neighbour, and the next run begins elsewhere") {
  Known known({{"x", AxisKind::kContinuous, 0.0, 1.0}, {"n", AxisKind::kInteger, 0, 3}});
  for (const double n : {0.0, 3.0}) {
    Known at_end({{"x", AxisKind::kContinuous, 0.0, 1.0}, {"n", AxisKind::kInteger, 0, 3}});
    at_end.archive.Add({{0.5, n}, 1.0});
    const std::vector<Point> neighbours = LocalModel(at_end, 3).Ask(9);
    REQUIRE(neighbours.size() == 1);
    CHECK(neighbours[0] == Point{0.5, n == 0.0 ? 1.0 : 2.0});
  }
  known.archive.Add({{0.50, 1.0}, 1.0});
  known.archive.Add({{0.55, 1.0}, 2.0});  // within a tenth of the first
  known.archive.Add({{0.90, 1.0}, 3.0});
  LocalModel search(known, 3);
  std::vector<double> starts;
  for (int i = 0; i < 400 && starts.size() < 2; ++i) {
    const bool begins = search.IsBetweenRuns();
    const std::vector<Point> points = search.Ask(1);
    if (begins || i == 0) starts.push_back(points[0][0]);
    search.Tell(std::vector<Evaluation>{{points[0], 5.0 + std::pow(points[0][0] - 0.5, 2)}});
  }
  CHECK(starts[0] == 0.5);
}

TEST_CASE("The next local run begins at the best point a tenth of an axis from the runs before") {
  Known known({{"x", AxisKind::kContinuous, 0.0, 10.0}});
  known.archive.Add({{5.0}, 0.0});
  known.archive.Add({{5.95}, 1.0});
  known.archive.Add({{6.05}, 2.0});
  known.archive.Add({{8.0}, 3.0});
  LocalModel search(known, 3);
  std::vector<double> asked;
  bool is_next = false;
  for (int i = 0; i < 200 && !is_next; ++i) {
    const Point point = search.Ask(1).front();
    asked.push_back(point[0]);
    is_next = point[0] == 5.95 || point[0] == 6.05 || point[0] == 8.0;
    search.Tell(std::vector<Evaluation>{{point, 5.0 + std::pow(point[0] - 5.0, 2)}});
  }
  CHECK(asked.front() == 5.0);
  CHECK(asked.back() == 6.05);
}

TEST_CASE("What was evaluated before is answered from the archive, and batches are cut") {
  /// Proposes the same three points over and over.
  class Stuck : public Strategy {
   public:
    explicit Stuck(std::vector<std::vector<double>>* told) : told_(told) {}
    std::vector<Point> Ask(int most) override {
      asked = most;
      return {{0.0}, {1.0}, {2.0}};
    }
    void Tell(std::span<const Evaluation> batch) override {
      std::vector<double>& losses = told_->emplace_back();
      for (const Evaluation& one : batch) losses.push_back(one.loss);
    }
    int asked = 0;

   private:
    std::vector<std::vector<double>>* told_;
  };
  auto known = std::make_unique<Known>(std::vector<Axis>{{"n", AxisKind::kInteger, 0, 5}});
  known->archive.Add({{1.0}, 7.0});
  std::vector<std::vector<double>> told;
  auto proposer = std::make_unique<Stuck>(&told);
  const Stuck* stuck = proposer.get();
  WithoutRepeats search(std::move(known), std::move(proposer), 4, 1);
  CHECK(search.Ask(9) == std::vector<Point>{{0.0}, {2.0}});
  CHECK(stuck->asked == 4);
  search.Tell(std::vector<Evaluation>{{{0.0}, 3.0}, {{2.0}, 4.0}});
  REQUIRE(told.size() == 1);
  CHECK(told[0] == std::vector<double>{3.0, 7.0, 4.0});
  const std::vector<Point> other = search.Ask(2);  // its proposer has nothing new: any other
  CHECK(stuck->asked == 2);
  REQUIRE(other.size() == 1);
  CHECK(other[0][0] >= 3.0);
  CHECK(told.size() == 1 + 20);
}

}  // namespace
}  // namespace rift::search
