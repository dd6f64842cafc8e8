#include "rift/statistics/random.hpp"

#include <cassert>
#include <cmath>
#include <numbers>

namespace rift::statistics {

namespace {

/// The finaliser of SplitMix64 [Steele, Lea, Flood 2014]: every input bit reaches every output bit.
std::uint64_t Mix(std::uint64_t value) {
  value += 0x9e3779b97f4a7c15ULL;
  value = (value ^ (value >> 30)) * 0xbf58476d1ce4e5b9ULL;
  value = (value ^ (value >> 27)) * 0x94d049bb133111ebULL;
  return value ^ (value >> 31);
}

}  // namespace

std::uint64_t SeedOfStream(std::uint64_t seed, std::uint64_t stream) {
  return Mix(Mix(seed) ^ Mix(~stream));
}

CounterRandom::CounterRandom(std::uint64_t seed, std::uint64_t stream)
    : key_(SeedOfStream(seed, stream)) {}

double CounterRandom::Uniform(std::uint64_t event, std::uint64_t draw) const {
  const std::uint64_t bits = Mix(Mix(key_ ^ Mix(event)) + draw);
  return (static_cast<double>(bits >> 11) + 0.5) * 0x1p-53;
}

double CounterRandom::Normal(std::uint64_t event, std::uint64_t draw) const {
  return std::sqrt(-2.0 * std::log(Uniform(event, draw))) *
         std::cos(2.0 * std::numbers::pi * Uniform(event, draw + 1));
}

double CounterRandom::HeavyTailed(std::uint64_t event, std::uint64_t draw,
                                  double degrees_of_freedom) const {
  assert(degrees_of_freedom > 2.0);
  const double nu = degrees_of_freedom;
  const double t = std::sqrt(nu * std::expm1(-2.0 / nu * std::log(Uniform(event, draw)))) *
                   std::cos(2.0 * std::numbers::pi * Uniform(event, draw + 1));
  return t * std::sqrt((nu - 2.0) / nu);
}

}  // namespace rift::statistics
