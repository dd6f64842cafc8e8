#include "rift/simulation/encoder.hpp"

#include <cmath>
#include <numbers>

namespace rift::simulation {

std::int64_t CountsAt(double angle_rad, double counts_per_rev) {
  return static_cast<std::int64_t>(
      std::floor(angle_rad * counts_per_rev / (2.0 * std::numbers::pi)));
}

}  // namespace rift::simulation
