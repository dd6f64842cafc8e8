#include "hardware/count_watch.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
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
      CHECK(Jump(side, 300 * way, 0, 0.49, -72 * way));  // it coasts on at most
      // Told to go back it goes back, and one that stands may be carried.
      CHECK_FALSE(Jump(side, 300 * way, -300 * way, 0.05, -5000 * way));
      CHECK_FALSE(Jump(side, 300 * way, 0, 0.51, -5000 * way));
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

/// A robot told to drive until 1 s and then to stand, whose wheel turns by `counts` from `from_s`
/// to `until_s` after that; readings each 0.05 s. What is said of it, at first.
std::optional<std::string> TurnsWhileStanding(const Side& side, int power, int counts,
                                              double from_s, double until_s,
                                              const std::optional<double>& restart_s = {}) {
  CountWatch watch(kMetresPerCount);
  for (int i = 0; i <= 100; ++i) {
    const double t_s = 0.05 * i, stands_s = t_s - 1.0;
    watch.SeeCommand(stands_s < 0.0 ? MilliPower{power, power} : MilliPower{}, t_s);
    if (restart_s && std::abs(stands_s - *restart_s) < 0.01) watch.Restart(t_s);
    const double share = std::clamp((stands_s - from_s) / (until_s - from_s), 0.0, 1.0);
    const auto turned = static_cast<std::int32_t>(std::lround(share * counts));
    if (side.IsFirst()) watch.SeeCounts(turned, 0, t_s + 0.01);
    if (!side.IsFirst()) watch.SeeCounts(0, turned, t_s + 0.01);
    const bool is_armed = !restart_s || stands_s >= *restart_s;
    if (auto said = watch.CheckStanding(); said && is_armed) return said;
  }
  return std::nullopt;
}

TEST_CASE("A wheel that turns although it has long been told to stand does not obey") {
  OnBothSides("left", "right", [](const Side& side) {
    for (const int way : {1, -1}) {
      // 0.02 m are 71.4 counts.
      CHECK(TurnsWhileStanding(side, 300, 72 * way, 1.2, 3.0));
      CHECK_FALSE(TurnsWhileStanding(side, 300, 71 * way, 1.2, 3.0));
      CHECK(TurnsWhileStanding(side, 0, 72 * way, 1.2, 3.0));  // never told to drive
      // It may take a second to hear of it and to roll out.
      CHECK_FALSE(TurnsWhileStanding(side, 300, 9000 * way, -1.0, 0.95));
      CHECK(TurnsWhileStanding(side, 300, 2000 * way, -1.0, 1.2));
      // Before it is armed it may be carried, and is given a second from then on.
      CHECK_FALSE(TurnsWhileStanding(side, 300, 2000 * way, 1.2, 2.5, 2.0));
      CHECK(TurnsWhileStanding(side, 300, 2000 * way, 1.2, 3.5, 2.0));
    }
    const std::string text = TurnsWhileStanding(side, 300, -200, 2.0, 2.04).value();
    CHECK_THAT(text, Catch::Contains(side.IsFirst() ? "the left wheel" : "the right wheel"));
    CHECK_THAT(text, Catch::Contains("by -0.056 m"));
    CHECK_THAT(text, Catch::Contains("for 2.1 s"));
  });
}

TEST_CASE("A wheel that is told to drive obeys however far it turns") {
  CountWatch watch(kMetresPerCount);
  for (int i = 0; i < 200; ++i) {
    watch.SeeCommand({300, i % 10 == 0 ? 0 : 300}, 0.05 * i);  // a zero now and then
    watch.SeeCounts(50 * i, 50 * i, 0.05 * i + 0.01);
    CHECK_FALSE(watch.CheckStanding());
  }
}

TEST_CASE("What a wheel did between readings that are far apart is not held against it") {
  CountWatch watch(kMetresPerCount);
  watch.SeeCommand({300, 300}, 0.0);
  watch.SeeCounts(0, 0, 0.0);
  watch.SeeCommand({}, 0.5);
  watch.SeeCounts(500, 500, 4.0);
  CHECK_FALSE(watch.CheckStanding());
  watch.SeeCounts(600, 500, 4.1);
  CHECK(watch.CheckStanding());
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
    CHECK_FALSE(see(99, 1.095));
    CHECK(see(99, 1.105));
    CHECK_FALSE(see(102, 1.16));
    CHECK_FALSE(see(103, 1.2));
    CHECK(see(102, 1.27));
    for (int i = 1; i < 20; ++i) CHECK_FALSE(see(102 + 2 * i, 1.3 + 0.05 * i));
  });
}

}  // namespace
}  // namespace rift::hardware
