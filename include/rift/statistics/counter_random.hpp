#pragma once

#include <cstdint>

namespace rift::statistics {

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
