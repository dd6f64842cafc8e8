#include "rift/statistics/bootstrap.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <span>
#include <vector>

#include "rift/statistics/descriptive.hpp"
#include "rift/statistics/random.hpp"

namespace rift::statistics {
namespace {

double MeanOf(std::span<const size_t> drawn, const std::vector<double>& values) {
  std::vector<double> chosen;
  for (const size_t i : drawn) chosen.push_back(values[i]);
  return Mean(chosen);
}

TEST_CASE("A bootstrap interval of a mean covers it about as often as it promises") {
  Random random(1, 1);
  int covered = 0;
  constexpr int kRounds = 400;
  for (int round = 0; round < kRounds; ++round) {
    std::vector<double> values(24);
    for (double& value : values) value = 5.0 + 2.0 * random.Normal();
    const Interval interval = BootstrapGroups(
        values.size(), [&](auto drawn) { return MeanOf(drawn, values); },
        {.resamples = 300, .confidence = 0.9}, static_cast<size_t>(round));
    covered += interval.low <= 5.0 && 5.0 <= interval.high;
  }
  // Percentile intervals of 24 values are a little short: 0.88 rather than 0.9.
  CHECK(covered == Approx(0.88 * kRounds).margin(0.06 * kRounds));
}

TEST_CASE("Draws that tell nothing are left out and fewer than two groups have no interval") {
  const std::vector<double> values{1.0, NAN, 1.0, 1.0};
  const Interval interval = BootstrapGroups(
      values.size(), [&](auto drawn) { return MeanOf(drawn, values); }, {}, 1);
  CHECK(interval.low == 1.0);
  CHECK(interval.high == 1.0);
  CHECK(std::isnan(BootstrapGroups(
                       1, [](auto) { return 1.0; }, {}, 1)
                       .low));
  CHECK(std::isnan(BootstrapGroups(
                       3, [](auto) { return NAN; }, {}, 1)
                       .high));
}

TEST_CASE("The share of the draws within an interval is widened by Student for few groups") {
  // Whatever is drawn, the values are 0 to 1000.
  const auto interval = [](std::size_t groups) {
    double next = 0.0;
    return BootstrapGroups(
        groups, [&next](auto) { return next++; }, {.resamples = 1001, .confidence = 0.5}, 1);
  };
  // Of two groups t is 1, times sqrt(2 / 1); of three sqrt(2 / 3), times sqrt(3 / 2).
  CHECK(interval(2).low == Approx(500.0 * (1.0 - std::erf(1.0))));
  CHECK(interval(2).high == Approx(500.0 * (1.0 + std::erf(1.0))));
  CHECK(interval(3).low == Approx(500.0 * (1.0 - std::erf(std::sqrt(0.5)))));
  CHECK(interval(3).high == Approx(500.0 * (1.0 + std::erf(std::sqrt(0.5)))));
}

TEST_CASE("A seed draws the same groups in every version of rift, so often as is asked") {
  std::vector<std::vector<size_t>> drawn;
  BootstrapGroups(
      5,
      [&drawn](std::span<const size_t> groups) {
        drawn.emplace_back(groups.begin(), groups.end());
        return 1.0;
      },
      {.resamples = 7}, 3);
  REQUIRE(drawn.size() == 7);
  Random random(3, 71);
  for (const std::vector<size_t>& groups : drawn) {
    REQUIRE(groups.size() == 5);
    for (const size_t group : groups) CHECK(group == random.Below(5));
  }
}

}  // namespace
}  // namespace rift::statistics
