#include "rift/statistics/descriptive.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

namespace rift::statistics {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::vector<double> OneTo(int n) {
  std::vector<double> values(static_cast<std::size_t>(n));
  std::iota(values.begin(), values.end(), 1.0);
  return values;
}

TEST_CASE("Quantiles are those of numpy and R") {
  CHECK(Quantile(OneTo(10), 0.95) == Approx(9.55));
  CHECK(Quantile(OneTo(10), 0.99) == Approx(9.91));
  CHECK(Quantile(OneTo(10), 0.25) == Approx(3.25));
  CHECK(Quantile({1.0, 2.0, 4.0, 8.0}, 0.4) == Approx(2.4));  // numpy.quantile([1, 2, 4, 8], 0.4)
  CHECK(Quantile(OneTo(10), 0.0) == 1.0);
  CHECK(Quantile(OneTo(10), 1.0) == 10.0);
}

TEST_CASE("The median is the middle value or half way between the middle two") {
  CHECK(Median({3.0, 1.0, 2.0}) == 2.0);
  CHECK(Median({4.0, 1.0, 2.0, 3.0}) == 2.5);
  CHECK(Median({7.0}) == 7.0);
  CHECK(Quantile({7.0}, 0.95) == 7.0);
}

TEST_CASE("Quantiles of nothing and of lists with NaN are NaN") {
  CHECK(std::isnan(Median({})));
  CHECK(std::isnan(Quantile({}, 0.95)));
  CHECK(std::isnan(Median({1.0, NAN, 2.0})));
  CHECK(std::isnan(Quantile({NAN, 1.0, 2.0}, 0.0)));
}

TEST_CASE("Ties and infinities are values like others") {
  CHECK(Median({1.0, 2.0, 2.0, 2.0, 9.0}) == 2.0);
  CHECK(Quantile({2.0, 2.0, 2.0}, 0.3) == 2.0);
  CHECK(Median({1.0, 2.0, kInfinity}) == 2.0);
  CHECK(Quantile({1.0, kInfinity, kInfinity}, 0.9) == kInfinity);
  CHECK(Quantile({1.0, 2.0, kInfinity}, 0.9) == kInfinity);
}

TEST_CASE("A share that is none is refused") {
  for (const double share : {-0.01, 1.01, double{NAN}}) {
    CHECK_THROWS_WITH(Quantile({1.0}, share), "quantile: the share must lie between 0 and 1");
  }
}

TEST_CASE("Quantiles rise with the share and stand at the order statistics whatever the order") {
  std::mt19937_64 generator(3);
  std::normal_distribution<double> normal;
  for (const int n : {1, 2, 3, 10, 101}) {
    std::vector<double> values(static_cast<std::size_t>(n));
    for (double& value : values) value = normal(generator);
    std::vector<double> sorted = values;
    std::sort(sorted.begin(), sorted.end());
    double last = sorted.front();
    for (int percent = 0; percent <= 100; ++percent) {
      const double quantile = Quantile(values, 0.01 * percent);
      INFO(percent << " % of " << n);
      CHECK(quantile >= last);
      CHECK(quantile == Quantile(sorted, 0.01 * percent));
      last = quantile;
    }
    CHECK(last == sorted.back());
    for (int i = 0; n > 1 && i < n; ++i) {
      CHECK(Quantile(values, i / (n - 1.0)) == Approx(sorted[static_cast<std::size_t>(i)]));
    }
  }
}

TEST_CASE("Quantiles of values scaled and moved are scaled and moved") {
  const std::vector<double> values{0.3, 5.0, -2.0, 8.0, 1.5, 4.0};
  std::vector<double> moved, mirrored;
  for (const double value : values) moved.push_back(3.0 * value - 7.0);
  for (const double value : values) mirrored.push_back(-value);
  for (const double share : {0.05, 0.4, 0.5, 0.95}) {
    CHECK(Quantile(moved, share) == Approx(3.0 * Quantile(values, share) - 7.0));
    CHECK(Quantile(mirrored, 1.0 - share) == Approx(-Quantile(values, share)));
  }
}

TEST_CASE("A central interval leaves out as much on either side") {
  const Interval interval = CentralInterval(OneTo(101), 0.9);
  CHECK(interval.low == Approx(6.0));
  CHECK(interval.high == Approx(96.0));
  CHECK(std::isnan(CentralInterval({}, 0.95).low));
}

}  // namespace
}  // namespace rift::statistics
