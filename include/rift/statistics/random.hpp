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

/// A seed for each stream of a seed, independent of each other.
std::uint64_t SeedOfStream(std::uint64_t seed, std::uint64_t stream);

/// Counter-based random numbers (Salmon et al. 2011, "Parallel random numbers: as easy as 1, 2,
/// 3"): the value of every event is a hash of (seed, stream, event, draw), so that no value depends
/// on how often or in which order the others were asked for.
class CounterRandom {
 public:
  /// Different streams of one seed are independent.
  CounterRandom(std::uint64_t seed, std::uint64_t stream);

  /// Evenly spread in (0, 1).
  double Uniform(std::uint64_t event, std::uint64_t draw) const;
  /// Standard normal; uses the draws `draw` and `draw + 1`.
  double Normal(std::uint64_t event, std::uint64_t draw) const;
  /// Student's t scaled to unit variance, for heavy tails; degrees_of_freedom > 2. Uses the draws
  /// `draw` and `draw + 1`. [Bailey 1994, polar generation of t]
  double HeavyTailed(std::uint64_t event, std::uint64_t draw, double degrees_of_freedom) const;

 private:
  std::uint64_t key_;
};

}  // namespace rift::statistics
