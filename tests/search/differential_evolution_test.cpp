// When an evolution begins anew, and with what, followed member by member from outside.
#include "search/differential_evolution.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

namespace rift::search {
namespace {

struct Member {
  double place, loss;
};

double WidthOf(const std::vector<Member>& members) {
  const auto [low, high] =
      std::minmax_element(members.begin(), members.end(),
                          [](const Member& a, const Member& b) { return a.place < b.place; });
  return high->place - low->place;
}

TEST_CASE(
    "An evolution whose members are within a millionth of an axis begins anew, and no other") {
  constexpr size_t kMembers = 12;
  int restarts = 0, nearly = 0;
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    Known known({{"a", AxisKind::kContinuous, 0.0, 1.0}});
    DifferentialEvolution search(known, seed);
    std::vector<Member> members;  // none: the next generation is the members themselves
    for (int generation = 0; generation < 120; ++generation) {
      const std::vector<Point> points = search.Ask(100);
      REQUIRE(points.size() == kMembers);
      std::vector<Evaluation> batch;
      std::vector<Member> trials;
      for (const Point& point : points) {
        batch.push_back({point, std::abs(point[0] - 0.37)});
        trials.push_back({point[0], batch.back().loss});
      }
      search.Tell(batch);
      if (members.empty()) {
        REQUIRE(WidthOf(trials) > 0.1);  // of twelve places anywhere
        members = trials;
        continue;
      }
      for (size_t i = 0; i < kMembers; ++i) {
        if (trials[i].loss <= members[i].loss) members[i] = trials[i];
      }
      const double width = WidthOf(members);
      CAPTURE(seed, generation, width);
      nearly += width >= 1e-6 && width < 2e-6;
      REQUIRE(width < 1.0);
      if (width >= 1e-6) continue;
      ++restarts;
      members.clear();
    }
  }
  CHECK(restarts >= 20);
  CHECK(nearly >= 5);
}

}  // namespace
}  // namespace rift::search
