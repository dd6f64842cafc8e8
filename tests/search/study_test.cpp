// The short form of search_study: bounds of counts, for what the tables in
// tests/benchmarks/README.md say of the portfolio.

#include <catch2/catch.hpp>

#include "benchmarks/search/functions.hpp"
#include "benchmarks/search/run_until.hpp"

namespace rift::test {
namespace {

int Successes(const std::string& name, search::Method method, int seeds, double target,
              int budget = 500) {
  int successes = 0;
  for (std::uint64_t seed = 1; seed <= static_cast<std::uint64_t>(seeds); ++seed) {
    std::vector<Task> tasks = Functions(seed);
    for (Task& task : DeceivingSpaces(seed)) tasks.push_back(std::move(task));
    for (const Task& task : tasks) {
      if (task.name != name) continue;
      successes += RunUntil(task, method, budget, target, 1000 + seed).reached_at.has_value();
    }
  }
  return successes;
}

TEST_CASE("In 500 evaluations the portfolio reaches what random search does in 100,000") {
  CHECK(Successes("ellipsoid", search::Method::kPortfolio, 12, 802.0) >= 8);
  CHECK(Successes("rosenbrock", search::Method::kPortfolio, 12, 28.0) >= 10);
  CHECK(Successes("rastrigin", search::Method::kPortfolio, 12, 11.5) >= 6);
}

TEST_CASE(
    "Where every axis is continuous a local model soon reaches what a long random search does") {
  CHECK(Successes("rosenbrock", search::Method::kPortfolio, 24, 28.0, 100) >= 12);
  CHECK(Successes("rastrigin", search::Method::kPortfolio, 24, 11.5, 100) >= 12);
}

TEST_CASE("A loss that is a quadratic form is solved as soon as there are points to fit one to") {
  CHECK(Successes("ellipsoid", search::Method::kPortfolio, 24, 802.0, 32) >= 23);
}

TEST_CASE("Among 101 minima a long search finds the one in half of the cases") {
  CHECK(Successes("peaks", search::Method::kPortfolio, 16, 0.258, 2000) >= 8);
}

TEST_CASE(
    "A failure in one corner of one category is found in as many evaluations as tell corners") {
  // 5 categories of 16 corners: 80, and 0.4 of 300 evaluations are corners.
  using enum search::AxisKind;
  const Task task{.name = "one corner",
                  .axes = {{"kind", kCategorical, 0.0, 4.0},
                           {"a", kContinuous, -1.0, 3.0},
                           {"b", kContinuous, 0.0, 10.0},
                           {"c", kContinuous, 5.0, 6.0},
                           {"d", kContinuous, 0.0, 1.0}},
                  .loss = [](const search::Point& x) {
                    const bool fails =
                        x[0] == 3.0 && x[1] > 2.9 && x[2] < 0.1 && x[3] > 5.99 && x[4] > 0.99;
                    return fails ? -1.0 : 1.0;
                  }};
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const RunResult run = RunUntil(task, search::Method::kPortfolio, 300, 0.0, seed);
    CHECK(run.reached_at.value_or(1000) <= 300);
  }
}

TEST_CASE("Where nothing points to a failure the portfolio finds half as many as random search") {
  for (const char* name : {"deceiving", "flat"}) {
    INFO(name);
    const int random = Successes(name, search::Method::kRandom, 30, 0.0);
    const int portfolio = Successes(name, search::Method::kPortfolio, 30, 0.0);
    CHECK(random >= 5);
    CHECK(2 * portfolio >= random);
  }
}

}  // namespace
}  // namespace rift::test
