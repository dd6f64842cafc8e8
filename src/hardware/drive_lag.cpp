#include "drive_lag.hpp"

#include <algorithm>
#include <cmath>

namespace rift::hardware {
namespace {

constexpr double kMost_s = 1.0;
constexpr double kEdge_s = 0.005;        // as near to the end of the search it is where that ended
constexpr double kLeastTurn_rad = 0.09;  // 5 deg: ten times what a standing tag jitters by
constexpr double kLeastScale = 0.4, kMostScale = 2.5;
constexpr double kMostNoise = 0.25;  // of a fit, as a share of the turn; as of the turn before

double Range(std::span<const Angle> angles) {
  const auto [low, high] = std::minmax_element(
      angles.begin(), angles.end(), [](const Angle& a, const Angle& b) { return a.rad < b.rad; });
  return high->rad - low->rad;
}

}  // namespace

std::optional<double> LagOverDrive(std::span<const Angle> seen, std::span<const Angle> wheels) {
  if (seen.empty() || !AreTimed(wheels)) return std::nullopt;
  const double seen_rad = Range(seen);
  if (std::min(seen_rad, Range(wheels)) < kLeastTurn_rad) return std::nullopt;
  const std::optional<Lag> lag = EstimateLag(seen, wheels, -kMost_s, kMost_s);
  if (!lag || lag->scale < kLeastScale || lag->scale > kMostScale) return std::nullopt;
  const bool is_inside = std::abs(lag->lag_s) < kMost_s - kEdge_s;
  if (!is_inside || lag->residual_rad > kMostNoise * seen_rad) return std::nullopt;
  return lag->lag_s;
}

}  // namespace rift::hardware
