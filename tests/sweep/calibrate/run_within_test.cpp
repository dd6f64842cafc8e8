#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <limits>
#include <set>

#include "rift/sweep/calibrate/likeness.hpp"
#include "sweep/calibrate/model.hpp"

namespace rift::sweep {
namespace {

double LengthWithin_m(double longest_m, const SimulatedTrial& twin) {
  return LengthByStrides_m(RunWithin(longest_m, twin, 0));
}

TEST_CASE("A simulated log that makes a detour is driven again, and the last try stands") {
  SimulatedTrial twin{.task =
                          std::vector<control::Waypoint>{{.name = "a", .x_m = 0.0, .y_m = 0.0},
                                                         {.name = "b", .x_m = 0.4, .y_m = 0.0},
                                                         {.name = "c", .x_m = 0.4, .y_m = 0.4}}};
  const double first_m = LengthWithin_m(std::numeric_limits<double>::infinity(), twin);
  const auto try_m = [&twin](int attempt) {
    SimulatedTrial one = twin;
    one.seed = SeedInPlace(twin.seed, 0, attempt);
    return LengthByStrides_m(Simulate(one).result.trajectory);
  };
  CHECK(try_m(0) == first_m);
  const double last_m = LengthWithin_m(0.0, twin);
  CHECK(last_m != first_m);
  CHECK(try_m(9) == last_m);
  CHECK(LengthWithin_m(first_m, twin) == first_m);  // as long as it may be

  const double limit_m = std::nextafter(first_m, 0.0);
  const double again_m = LengthWithin_m(limit_m, twin);
  CHECK(again_m != first_m);
  CHECK((again_m <= limit_m || again_m == last_m));
  CHECK(LengthWithin_m(again_m, twin) <= again_m);
}

TEST_CASE("A simulated log that does not arrive is driven again, as no log of a fit is one") {
  SimulatedTrial twin{.task =
                          std::vector<control::Waypoint>{{.name = "a", .x_m = 0.0, .y_m = 0.0},
                                                         {.name = "b", .x_m = 0.4, .y_m = 0.0},
                                                         {.name = "c", .x_m = 0.4, .y_m = 0.4}}};
  const auto try_of = [&twin](int repeat, int attempt) {
    SimulatedTrial one = twin;
    one.seed = SeedInPlace(twin.seed, repeat, attempt);
    return Simulate(one).result;
  };
  const auto check_is = [](const trajectory::Trajectory& path, const trial::TrialResult& result) {
    REQUIRE(path.poses.size() == result.trajectory.poses.size());
    CHECK(path.poses.back().t_s == result.trajectory.poses.back().t_s);
    CHECK(path.poses.back().x_m == result.trajectory.poses.back().x_m);
  };
  constexpr double kAnyLength_m = std::numeric_limits<double>::infinity();
  twin.trial.timeout_s = 8.0;
  // A repeat whose first try takes longer than its second.
  trial::TrialResult slow, fast;
  const auto is_meant = [&](int repeat) {
    slow = try_of(repeat, 0), fast = try_of(repeat, 1);
    return slow.outcome == trial::Outcome::kReached && fast.outcome == trial::Outcome::kReached &&
           slow.Duration_s() > fast.Duration_s();
  };
  int repeat = 0;
  while (!is_meant(repeat)) REQUIRE(++repeat < 30);
  check_is(RunWithin(kAnyLength_m, twin, repeat), slow);
  twin.trial.timeout_s = 0.5 * (slow.Duration_s() + fast.Duration_s());
  check_is(RunWithin(kAnyLength_m, twin, repeat), fast);
  twin.trial.timeout_s = 0.5;  // none arrives: the last of ten stands
  check_is(RunWithin(kAnyLength_m, twin, repeat), try_of(repeat, 9));
}

TEST_CASE("No run in the place of a log has the seed of another, nor of one that predicts") {
  std::set<std::uint64_t> seeds;
  size_t count = 0;
  for (std::uint64_t log = 0; log < 12; ++log) {
    const std::uint64_t first = 7 + log * kSeedsOfLog;
    for (std::uint64_t run = 0; run < 20; ++run, ++count) seeds.insert(first + run);
    for (int repeat = 0; repeat < 30; ++repeat) {
      for (int attempt = 0; attempt < kMostTries; ++attempt, ++count) {
        const std::uint64_t seed = SeedInPlace(first, repeat, attempt);
        seeds.insert(seed);
        CHECK(seed < (std::uint64_t{1} << 31));
      }
    }
  }
  CHECK(seeds.size() == count);
  // Four repeats between the seeds of two logs, the next ones beyond those of 2000 logs.
  CHECK(SeedInPlace(7, 0, 0) == 20'007);
  CHECK(SeedInPlace(7, 3, 0) == 80'007);
  CHECK(SeedInPlace(7, 4, 0) == 200'020'007);
  CHECK(SeedInPlace(7, 10, 2) == 400'062'007);
}

}  // namespace
}  // namespace rift::sweep
