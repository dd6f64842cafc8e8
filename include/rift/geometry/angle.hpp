#pragma once

#include <cmath>
#include <numbers>

namespace rift::geometry {

inline constexpr double kPi = std::numbers::pi;

constexpr double RadFromDeg(double angle_deg) { return angle_deg * (kPi / 180.0); }
constexpr double DegFromRad(double angle_rad) { return angle_rad * (180.0 / kPi); }

/// The same direction in [-pi, pi]. NaN and infinities become NaN.
inline double WrapToPi(double angle_rad) {
  // The remainder of these is the angle itself, bit for bit, at 15 times the price.
  if (std::abs(angle_rad) <= kPi) return angle_rad;
  return std::remainder(angle_rad, 2.0 * kPi);
}

}  // namespace rift::geometry
