// Where the runs of local models begin.
#include "search/local_model.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <optional>
#include <vector>

namespace rift::search {
namespace {

/// The first point of the second run.
std::optional<double> SecondStart(const Known& known) {
  LocalModel search(known, 3);
  int runs = 0;
  for (int i = 0; i < 200; ++i) {
    // A run that is over is followed by the next within one call: the loss rises from its start.
    const double asked = search.Ask(1).front()[0];
    const bool is_far = std::abs(asked - 0.5) > 0.3;
    runs += is_far;
    if (runs > 0) return asked;
    search.Tell(std::vector<Evaluation>{{{asked}, 5.0 + std::pow(asked - 0.5, 2)}});
  }
  return std::nullopt;
}

TEST_CASE("A local run begins at one of the two hundred best points, else anywhere") {
  for (const int near : {199, 200}) {
    Known known({{"x", AxisKind::kContinuous, 0.0, 1.0}});
    for (int i = 0; i < near; ++i) known.archive.Add({{0.5 + 1e-5 * i}, 1.0 * i});
    known.archive.Add({{0.85}, 1000.0});
    const std::optional<double> start = SecondStart(known);
    REQUIRE(start);
    CAPTURE(near, *start);
    CHECK((*start == 0.85) == (near == 199));
  }
}

/// How many points a run asks for from the middle of so many ranges, where each point is better
/// than all before it.
int LongestRun(size_t axes) {
  Known known(std::vector<Axis>(axes, {"x", AxisKind::kContinuous, 0.0, 1.0}));
  known.archive.Add({Point(axes, 0.5), 0.0});
  const Point next(axes, 0.3);
  known.archive.Add({next, 1.0});
  LocalModel search(known, 3);
  for (int asked = 0; asked < 1000; ++asked) {
    const Point point = search.Ask(1).front();
    if (point == next) return asked;
    search.Tell(std::vector<Evaluation>{{point, -1.0 - asked}});
  }
  return 1000;
}

TEST_CASE("A local run that never comes to an end has sixty points for each of two axes or more") {
  CHECK(LongestRun(1) == 120);
  CHECK(LongestRun(2) == 120);
  CHECK(LongestRun(3) == 180);
  CHECK(LongestRun(5) == 300);
}

TEST_CASE("The last steps of a local run are a hundred millionth of an axis") {
  Known known({{"x", AxisKind::kContinuous, 0.0, 1.0}});
  known.archive.Add({{0.5}, 5.0});
  known.archive.Add({{0.9}, 6.0});
  LocalModel search(known, 3);
  std::vector<double> off;
  for (int i = 0; i < 200; ++i) {
    const double asked = search.Ask(1).front()[0];
    if (asked == 0.9) break;
    off.push_back(std::abs(asked - 0.5));
    search.Tell(std::vector<Evaluation>{{{asked}, std::abs(asked - 0.5)}});
  }
  REQUIRE(off.size() < 120);
  double last = 1.0;
  for (const double one : off)
    if (one > 0.0) last = std::min(last, one);
  CHECK(last == Approx(1e-8));
}

}  // namespace
}  // namespace rift::search
