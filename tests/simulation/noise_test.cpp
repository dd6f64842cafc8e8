#include "rift/simulation/noise.hpp"

#include <catch2/catch.hpp>
#include <cmath>

namespace rift::simulation {
namespace {

TEST_CASE("A noise value depends on seed stream event and draw alone") {
  const Noise noise(1, 2);
  const double value = noise.Uniform(10, 3);
  CHECK(noise.Uniform(11, 3) != value);
  CHECK(noise.Uniform(10, 3) == value);
  CHECK(noise.Uniform(10, 4) != value);
  CHECK(Noise(2, 2).Uniform(10, 3) != value);
  CHECK(Noise(1, 3).Uniform(10, 3) != value);
}

TEST_CASE("Normal and heavy tailed noise have unit variance and the tail they name") {
  const Noise noise(7, 1);
  const int n = 200'000;
  double normal_square = 0.0, heavy_square = 0.0, product = 0.0;
  int normal_far = 0, heavy_far = 0;
  for (int i = 0; i < n; ++i) {
    const double normal = noise.Normal(i, 0), heavy = noise.HeavyTailed(i, 2, 6.0);
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

}  // namespace
}  // namespace rift::simulation
