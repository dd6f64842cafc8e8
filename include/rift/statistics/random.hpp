#pragma once

#include <boost/random/mersenne_twister.hpp>
#include <boost/random/normal_distribution.hpp>
#include <boost/random/uniform_01.hpp>
#include <cstdint>
#include <random>

namespace rift::statistics {

/// A sequence of random numbers for one user, where the order of the draws is fixed; else see
/// CounterRandom. The distributions are Boost's, since those of the standard differ from library to
/// library.
class Random {
 public:
  /// Different streams of one seed are independent.
  Random(std::uint64_t seed, std::uint64_t stream) : engine_(Seeded(seed, stream)) {}

  /// In [0, 1).
  double Uniform() { return boost::random::uniform_01<double>()(engine_); }
  double Normal() { return normal_(engine_); }
  /// A whole number in [0, n), n >= 1.
  std::uint64_t Below(std::uint64_t n) {
    return static_cast<std::uint64_t>(Uniform() * static_cast<double>(n));
  }

 private:
  static boost::random::mt19937_64 Seeded(std::uint64_t seed, std::uint64_t stream) {
    std::seed_seq words{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32),
                        static_cast<std::uint32_t>(stream),
                        static_cast<std::uint32_t>(stream >> 32)};
    return boost::random::mt19937_64(words);
  }

  boost::random::mt19937_64 engine_;
  boost::random::normal_distribution<double> normal_;
};

}  // namespace rift::statistics
