#pragma once

#include <random>
#include <vector>

#include "path_shape.hpp"

namespace rift::gap {

/// Paths of which some are real; the same simulator and robot would let any of them be so.
struct ShuffleGroup {
  std::vector<Shape> reals;
  std::vector<Shape> sims;
};

struct EnergyTest {
  double energy_m;
  double p;
};

/// 2 E|X - Y| - E|X - X'| - E|Y - Y'| over all paths, and the share of `shuffles` within the groups
/// that give as much [Szekely and Rizzo 2004]. NaN unless both sides have two paths or more.
EnergyTest TestEnergy(const std::vector<ShuffleGroup>& groups, int shuffles,
                      std::mt19937_64& generator);

}  // namespace rift::gap
