#pragma once

#include <random>
#include <span>
#include <vector>

#include "arc_path.hpp"

namespace rift::gap {

/// A path at evenly spaced u, from 0 to 1.
using Shape = Points;

Shape ShapeOf(const trajectory::Trajectory& path, int points);

/// The mean point at each u. All shapes have the same number of points, and there is one at least.
Shape MeanShape(std::span<const Shape> shapes);

/// Mean distance at equal u.
double Distance_m(const Shape& a, const Shape& b);

/// Signed distance of each point from the straight line that fits them best.
std::vector<double> LateralResiduals_m(const Shape& shape);

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
