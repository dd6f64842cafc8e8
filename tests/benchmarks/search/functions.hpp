#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "rift/search/strategy.hpp"

namespace rift::test {

/// A function to be minimised whose least value is 0.
struct Task {
  std::string name;
  std::vector<search::Axis> axes;
  std::function<double(const search::Point&)> loss;
  /// Expected evaluations of random search until the loss is at most a target: one over the share
  /// of the volume that is. From the quadratic form at the optimum, hence for targets of which
  /// that form holds (1e-6 and below; for the ellipsoid any that lies within the bounds).
  std::function<double(double)> random_evaluations = nullptr;
};

inline constexpr int kDimensions = 5;

/// The functions of the study, on [-5, 5]^5, each seed with an optimum of its own in [-4, 4]^5 and,
/// for the ellipsoid and the peaks, a rotation of its own.
///   rastrigin    sum z^2 + 10 (1 - cos 2 pi z)
///   rosenbrock   sum 100 (z_i^2 - z_i+1)^2 + (z_i - 1)^2, z = 1 at the optimum
///   ellipsoid    axes of 1 to 1e3 (squared 1e6), rotated
///   peaks        the highest of 101 Gaussian peaks of different heights and widths, rotated (as
///                Gallagher's, BBOB f21)
std::vector<Task> Functions(std::uint64_t seed);

/// Two mixed spaces (four ranges and a category of five) whose failures, a loss below zero in a
/// share of 7.4e-4 of the volume (31 of 100 random searches of 500 evaluations meet one), nothing
/// points to:
///   deceiving    one category is worse everywhere but in a box; in the others the loss falls
///                towards a place that does not fail
///   flat         the loss falls towards the middle, where it does not fail; far out it is flat but
///                for a box in one category
std::vector<Task> DeceivingSpaces(std::uint64_t seed);

}  // namespace rift::test
