#include "rift/statistics/random.hpp"

#include <catch2/catch.hpp>
#include <cmath>

namespace rift::statistics {
namespace {

TEST_CASE("A counter-based value depends on seed stream event and draw alone") {
  const CounterRandom random(1, 2);
  const double value = random.Uniform(10, 3);
  CHECK(random.Uniform(11, 3) != value);
  CHECK(random.Uniform(10, 3) == value);
  CHECK(random.Uniform(10, 4) != value);
  CHECK(CounterRandom(2, 2).Uniform(10, 3) != value);
  CHECK(CounterRandom(1, 3).Uniform(10, 3) != value);
}

TEST_CASE("Normal and heavy tailed values have unit variance and the tail they name") {
  const CounterRandom random(7, 1);
  const int n = 200'000;
  double normal_square = 0.0, heavy_square = 0.0, product = 0.0;
  int normal_far = 0, heavy_far = 0;
  for (int i = 0; i < n; ++i) {
    const double normal = random.Normal(i, 0), heavy = random.HeavyTailed(i, 2, 6.0);
    normal_square += normal * normal;
    heavy_square += heavy * heavy;
    product += normal * heavy;
    normal_far += std::abs(normal) > 3.0;
    heavy_far += std::abs(heavy) > 3.027;  // 99 % point of t(6) at unit variance: 3.707 / sqrt(1.5)
  }
  CHECK(normal_square / n == Approx(1.0).margin(0.02));
  CHECK(heavy_square / n == Approx(1.0).margin(0.04));
  CHECK(product / n == Approx(0.0).margin(0.01));
  CHECK(static_cast<double>(normal_far) / n == Approx(0.0027).margin(0.0005));
  CHECK(static_cast<double>(heavy_far) / n == Approx(0.0100).margin(0.001));
}

TEST_CASE("The values of a seed are the same on every platform and in every version") {
  // Simulated runs are repeated from their seeds, so these numbers may not change.
  const CounterRandom random(7, 1);
  CHECK(random.Uniform(0, 0) == 0.63214900071788227);
  CHECK(random.Uniform(123, 4) == 0.16710453897637106);
}

}  // namespace
}  // namespace rift::statistics
