#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <set>

#include "rift/search/options.hpp"

namespace rift::search {
namespace {

constexpr auto kNames = EnumNames(Method{});

std::vector<Method> AllMethods() {
  std::vector<Method> methods;
  for (std::size_t i = 0; i < kNames.size(); ++i) methods.push_back(static_cast<Method>(i));
  return methods;
}

std::string NameOf(Method method) { return std::string(kNames[static_cast<std::size_t>(method)]); }

SearchOptions With(Method method) {
  SearchOptions options;
  options.strategy = method;
  return options;
}

struct NamedSpace {
  std::string name;
  std::vector<Axis> axes;
};

std::vector<NamedSpace> Spaces() {
  const Axis speed{"speed", AxisKind::kContinuous, -0.15, 0.40};
  const Axis count{"count", AxisKind::kInteger, -3, 12};
  const Axis surface{"surface", AxisKind::kCategorical, 0, 4};
  const Axis pace{"pace", AxisKind::kCategorical, 0, 1};
  const Axis fixed{"fixed", AxisKind::kContinuous, 2.5, 2.5};
  return {{"mixed", {speed, surface, count, pace}},
          {"one continuous axis", {speed}},
          {"one integer axis", {count}},
          {"one category", {surface}},
          {"categories alone", {surface, pace}},
          {"integers and categories", {count, surface}},
          {"integers alone", {count, {"steps", AxisKind::kInteger, -2, 2}}},
          {"an axis without width", {fixed, speed}},
          {"an integer and a category without choice",
           {speed, {"one", AxisKind::kInteger, 4, 4}, {"only", AxisKind::kCategorical, 0, 0}}},
          {"wide", {{"huge", AxisKind::kContinuous, -1e308, 1e308}, speed}}};
}

/// Smooth, with a level of each category and a whole number that suit it best.
double Bowl(const Point& point) {
  double sum = 0.0;
  for (std::size_t i = 0; i < point.size(); ++i) {
    const double off = std::tanh(1e-3 * point[i]) * 1e3 - 0.1 * static_cast<double>(i + 1);
    sum += off * off;
  }
  return sum;
}

/// As Bowl, but a fifth of the points have no loss, or an infinite one.
double Holed(const Point& point) {
  const double phase = std::sin(1e3 * point.front() + static_cast<double>(point.size()));
  if (phase > 0.8) return std::numeric_limits<double>::quiet_NaN();
  if (phase < -0.9) return std::numeric_limits<double>::infinity();
  return Bowl(point);
}

using Loss = double (*)(const Point&);

std::vector<Evaluation> Evaluated(const std::vector<Point>& points, Loss loss) {
  std::vector<Evaluation> batch;
  for (const Point& point : points) batch.push_back({point, loss(point)});
  return batch;
}

/// All batches until the budget is spent or nothing is left.
std::vector<std::vector<Evaluation>> Run(Strategy& strategy, int budget, Loss loss) {
  std::vector<std::vector<Evaluation>> batches;
  int spent = 0;
  while (spent < budget) {
    const std::vector<Point> points = strategy.Ask(budget - spent);
    if (points.empty()) break;
    batches.push_back(Evaluated(points, loss));
    strategy.Tell(batches.back());
    spent += static_cast<int>(points.size());
  }
  return batches;
}

std::vector<Evaluation> Flat(const std::vector<std::vector<Evaluation>>& batches) {
  std::vector<Evaluation> all;
  for (const auto& batch : batches) all.insert(all.end(), batch.begin(), batch.end());
  return all;
}

void CheckInside(const std::vector<Axis>& axes, const Point& point) {
  REQUIRE(point.size() == axes.size());
  for (std::size_t i = 0; i < axes.size(); ++i) {
    INFO(axes[i].name << " = " << point[i]);
    REQUIRE((point[i] >= axes[i].min && point[i] <= axes[i].max));
    if (axes[i].kind != AxisKind::kContinuous) REQUIRE(point[i] == std::floor(point[i]));
  }
}

void CheckProposals(const std::vector<Axis>& axes,
                    const std::vector<std::vector<Evaluation>>& batches) {
  std::set<Point> seen;
  for (const auto& batch : batches) {
    REQUIRE(batch.size() <= 8);
    for (const Evaluation& evaluation : batch) {
      CheckInside(axes, evaluation.point);
      REQUIRE(seen.insert(evaluation.point).second);
    }
  }
}

void CheckGoesOn(Strategy& strategy, const std::vector<std::vector<Evaluation>>& batches,
                 int budget) {
  for (const auto& batch : batches) {
    const std::vector<Point> asked = strategy.Ask(budget);
    REQUIRE(asked.size() == batch.size());
    for (std::size_t i = 0; i < asked.size(); ++i) REQUIRE(asked[i] == batch[i].point);
    strategy.Tell(batch);
    budget -= static_cast<int>(batch.size());
  }
}

// A run of each method in each space is what costs, so both are held to the same ones.
TEST_CASE("Proposals lie within the bounds, are new, and the same when a search is told again") {
  for (const Method method : AllMethods()) {
    for (const NamedSpace& space : Spaces()) {
      INFO(NameOf(method) << " in " << space.name);
      const auto batches = Run(*MakeStrategy(With(method), space.axes, 64, 7), 64, Holed);
      CheckProposals(space.axes, batches);
      CheckGoesOn(*MakeStrategy(With(method), space.axes, 64, 7), batches, 64);
    }
  }
}

TEST_CASE("Another seed leads to other points") {
  const std::vector<Axis> axes = Spaces().front().axes;
  for (const Method method : AllMethods()) {
    INFO(NameOf(method));
    const auto a = MakeStrategy(With(method), axes, 100, 1)->Ask(8);
    const auto b = MakeStrategy(With(method), axes, 100, 2)->Ask(8);
    CHECK(a != b);
  }
}

TEST_CASE("What is told decides what is asked next in all methods that learn") {
  const std::vector<Axis> axes = Spaces().front().axes;
  for (const Method method : {Method::kPortfolio, Method::kCmaEs, Method::kSurrogate,
                              Method::kBobyqa, Method::kEvolution, Method::kCrs}) {
    INFO(NameOf(method));
    const auto a = MakeStrategy(With(method), axes, 100, 1);
    const auto b = MakeStrategy(With(method), axes, 100, 1);
    const auto of_bowl = Flat(Run(*a, 100, Bowl));
    const auto of_cone = Flat(Run(*b, 100, [](const Point& p) { return -Bowl(p); }));
    CHECK_FALSE(std::equal(of_bowl.begin(), of_bowl.end(), of_cone.begin(), of_cone.end(),
                           [](const auto& x, const auto& y) { return x.point == y.point; }));
  }
}

TEST_CASE("A finite space is visited point by point and then nothing is asked") {
  for (const Method method : AllMethods()) {
    for (const NamedSpace& space : Spaces()) {
      double points = 1.0;
      bool is_finite = true;
      for (const Axis& axis : space.axes) {
        is_finite = is_finite && axis.kind != AxisKind::kContinuous;
        points *= axis.max - axis.min + 1.0;
      }
      if (!is_finite) continue;
      INFO(NameOf(method) << " in " << space.name);
      const auto strategy = MakeStrategy(With(method), space.axes, 1000, 5);
      CHECK(static_cast<double>(Flat(Run(*strategy, 1000, Holed)).size()) == points);
      CHECK(strategy->Ask(1000).empty());
    }
  }
}

TEST_CASE("A space of one point is tried once") {
  const std::vector<Axis> axes{{"fixed", AxisKind::kContinuous, 2.5, 2.5},
                               {"one", AxisKind::kInteger, -4, -4},
                               {"only", AxisKind::kCategorical, 0, 0}};
  for (const Method method : AllMethods()) {
    INFO(NameOf(method));
    const auto strategy = MakeStrategy(With(method), axes, 50, 5);
    const auto tried = Flat(Run(*strategy, 50, Bowl));
    REQUIRE(tried.size() == 1);
    CHECK(tried.front().point == Point{2.5, -4.0, 0.0});
  }
}

TEST_CASE("Budgets below the first design are spent to the last evaluation") {
  for (const Method method : AllMethods()) {
    for (const NamedSpace& space : Spaces()) {
      for (const int budget : {1, 2, 3, 5}) {
        INFO(NameOf(method) << " in " << space.name << " with " << budget);
        const auto strategy = MakeStrategy(With(method), space.axes, budget, 13);
        CHECK(Flat(Run(*strategy, budget, Bowl)).size() == static_cast<std::size_t>(budget));
        CHECK(Run(*strategy, 1, Bowl).size() <= 1);  // more than promised is no fault
      }
    }
  }
}

TEST_CASE("A search in which every trial fails goes on to its end") {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const std::vector<Loss> failures{
      [](const Point&) { return std::numeric_limits<double>::quiet_NaN(); },
      [](const Point&) { return kInfinity; }, [](const Point&) { return -kInfinity; },
      [](const Point& p) { return p.front() < 0.1 ? kInfinity : -kInfinity; }};
  for (const Method method : AllMethods()) {
    for (std::size_t i = 0; i < failures.size(); ++i) {
      INFO(NameOf(method) << " with failures of kind " << i);
      const auto strategy = MakeStrategy(With(method), Spaces().front().axes, 200, 11);
      CHECK(Flat(Run(*strategy, 200, failures[i])).size() == 200);
    }
  }
}

TEST_CASE("Losses as large as numbers get are taken") {
  for (const Method method : AllMethods()) {
    INFO(NameOf(method));
    const auto strategy = MakeStrategy(With(method), Spaces().front().axes, 200, 11);
    const Loss loss = [](const Point& p) { return p.front() < 0.1 ? 1.7e308 : -1.7e308; };
    CHECK(Flat(Run(*strategy, 200, loss)).size() == 200);
  }
}

TEST_CASE("A search in which every trial costs the same goes on to its end") {
  for (const Method method : AllMethods()) {
    INFO(NameOf(method));
    const auto strategy = MakeStrategy(With(method), Spaces().front().axes, 300, 11);
    CHECK(Flat(Run(*strategy, 300, [](const Point&) { return 1.0; })).size() == 300);
  }
}

TEST_CASE("One point at a time can be asked for") {
  for (const Method method : AllMethods()) {
    INFO(NameOf(method));
    const auto strategy = MakeStrategy(With(method), Spaces().front().axes, 100, 11);
    for (int i = 0; i < 100; ++i) {
      const std::vector<Point> points = strategy->Ask(1);
      REQUIRE(points.size() == 1);
      strategy->Tell(Evaluated(points, Bowl));
    }
  }
}

TEST_CASE("Evaluations of other points than those asked are refused") {
  const auto strategy = MakeStrategy({}, {{"x", AxisKind::kContinuous, 0.0, 1.0}}, 10, 1);
  const std::vector<Point> asked = strategy->Ask(2);
  REQUIRE(asked.size() == 2);
  const std::vector<Evaluation> swapped{{asked[1], 0.0}, {asked[0], 0.0}};
  CHECK_THROWS_AS(strategy->Tell(swapped), std::invalid_argument);
  CHECK_THROWS_WITH(strategy->Tell(std::vector<Evaluation>{{asked[0], 0.0}}),
                    "search: told 1 evaluations that are not the 2 points asked last, in order");
  strategy->Tell(Evaluated(asked, Bowl));
}

TEST_CASE("Axes that make no sense are refused by name") {
  using enum AxisKind;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto make = [](const Axis& axis) { MakeStrategy({}, {axis}, 10, 1); };
  CHECK_THROWS_WITH(make({"mu", kContinuous, 1.0, 0.5}), Catch::Contains("axis mu from 1 to 0.5"));
  CHECK_THROWS_WITH(make({"mu", kContinuous, nan, 0.5}), Catch::Contains("finite"));
  CHECK_THROWS_WITH(make({"n", kInteger, 0.5, 2.0}), Catch::Contains("whole"));
  CHECK_THROWS_WITH(make({"c", kCategorical, 1.0, 2.0}), Catch::Contains("from 0"));
  CHECK_THROWS_WITH(MakeStrategy({}, {}, 10, 1), Catch::Contains("at least one axis"));
  CHECK_THROWS_WITH(MakeStrategy({}, {{"x"}}, 0, 1), Catch::Contains("budget of 0"));
}

}  // namespace
}  // namespace rift::search
