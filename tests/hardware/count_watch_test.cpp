#include "hardware/count_watch.hpp"

#include <catch2/catch.hpp>
#include <limits>

#include "support/mirror.hpp"

namespace rift::hardware {
namespace {

using test::OnBothSides;
using test::Side;

constexpr double kMetresPerCount = 0.00028;

/// What is said of a wheel that is told `power` for a second and then `then`, and that jumps
/// `after_s` later, from 0 to `counts`.
std::optional<std::string> Jump(const Side& side, int power, int then, double after_s, int counts) {
  CountWatch watch(kMetresPerCount);
  watch.SeeCounts(0, 0, 0.0);
  for (int i = 0; i <= 20; ++i) {
    watch.SeeCommand(side.Of<MilliPower>(power, 0), 0.05 * i);
    watch.SeeCounts(0, 0, 0.05 * i + 0.01);
  }
  for (int i = 0; 0.05 * i < after_s; ++i) {
    watch.SeeCommand(side.Of<MilliPower>(then, 0), 1.001 + 0.05 * i);
  }
  return side.IsFirst() ? watch.SeeCounts(counts, 0, 1.001 + after_s)
                        : watch.SeeCounts(0, counts, 1.001 + after_s);
}

TEST_CASE("Counts that jump against all that a wheel was told lately are a restart") {
  OnBothSides("left", "right", [](const Side& side) {
    for (const int way : {1, -1}) {
      // 0.02 m are 71.4 counts.
      CHECK(Jump(side, 300 * way, 300 * way, 0.05, -72 * way));
      CHECK_FALSE(Jump(side, 300 * way, 300 * way, 0.05, -71 * way));
      CHECK_FALSE(Jump(side, 300 * way, 300 * way, 0.05, 5000 * way));
      CHECK(Jump(side, 300 * way, 0, 0.3, -72 * way));  // it coasts on at most
      // Told to go back it goes back, and one that stands may be carried.
      CHECK_FALSE(Jump(side, 300 * way, -300 * way, 0.05, -5000 * way));
      CHECK_FALSE(Jump(side, 300 * way, 0, 0.6, -5000 * way));
      CHECK_FALSE(Jump(side, 0, 0, 0.05, -5000 * way));
    }
    const std::string text = Jump(side, 300, 300, 0.05, -257).value();
    CHECK_THAT(text, Catch::Contains(side.IsFirst() ? "the left wheel" : "the right wheel"));
    CHECK_THAT(text, Catch::Contains("by -257 within"));
  });
}

TEST_CASE("Counts that are read seldom may have gone either way since the reading before") {
  for (const double begins_s : {0.02, -0.3}) {
    CountWatch watch(kMetresPerCount);
    watch.SeeCommand({-300, 300}, begins_s);
    watch.SeeCommand({0, 0}, begins_s + 0.04);
    watch.SeeCounts(0, 0, 0.0);
    watch.SeeCommand({300, -300}, 0.56);
    INFO("told to go back from " << begins_s << " s on");
    CHECK_FALSE(watch.SeeCounts(-100, 100, 0.6));
  }
  CountWatch watch(kMetresPerCount);  // told nothing of the kind since long
  watch.SeeCommand({-300, 300}, -0.8);
  watch.SeeCommand({0, 0}, -0.7);
  watch.SeeCounts(0, 0, 0.0);
  watch.SeeCommand({300, -300}, 0.56);
  CHECK(watch.SeeCounts(-100, 100, 0.6));
}

TEST_CASE("Counts that jump by half of their range do not rest") {
  CountWatch watch(kMetresPerCount);
  watch.SeeCounts(0, 0, 0.0);
  for (int i = 1; i <= 3; ++i) {
    const std::int32_t counts = i % 2 == 0 ? 0 : std::numeric_limits<std::int32_t>::min();
    watch.SeeCounts(counts, counts, 0.1 * i);
    CHECK_FALSE(watch.Rest());
  }
}

TEST_CASE("The end of the counters' range is no jump") {
  constexpr std::int32_t kLast = std::numeric_limits<std::int32_t>::max();
  constexpr std::int32_t kFirst = std::numeric_limits<std::int32_t>::min();
  CountWatch watch(kMetresPerCount);
  watch.SeeCommand({300, 300}, 0.0);
  CHECK_FALSE(watch.SeeCounts(kLast - 3, kLast - 3, 0.01));
  CHECK_FALSE(watch.SeeCounts(kFirst + 30, kFirst + 30, 0.06));
  CHECK(watch.SeeCounts(kLast - 60, kFirst + 40, 0.11));
}

TEST_CASE("Wheels rest when their counts stay for a tenth of a second, but for one to each side") {
  OnBothSides("left", "right", [](const Side& side) {
    CountWatch watch(kMetresPerCount);
    const auto see = [&](int counts, double at_s) {
      if (side.IsFirst()) watch.SeeCounts(counts, 7, at_s);
      if (!side.IsFirst()) watch.SeeCounts(7, counts, at_s);
      return watch.Rest();
    };
    CHECK_FALSE(watch.Rest());
    CHECK_FALSE(see(100, 1.0));
    CHECK_FALSE(see(101, 1.05));
    CHECK(see(99, 1.11));
    CHECK_FALSE(see(102, 1.16));
    CHECK_FALSE(see(103, 1.2));
    CHECK(see(102, 1.27));
    for (int i = 1; i < 20; ++i) CHECK_FALSE(see(102 + 2 * i, 1.3 + 0.05 * i));
  });
}

}  // namespace
}  // namespace rift::hardware
