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

}  // namespace
}  // namespace rift::search
