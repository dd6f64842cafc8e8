#pragma once

namespace rift::hardware {

inline constexpr double kKept_s = 4.0;      ///< of what pose and wheels did
inline constexpr double kRolls_m = 0.0005;  ///< of the wheels from picture to picture: they roll

/// Forward and turning part of a motion, both in metres at a wheel: what the wheels rolled, or what
/// the pose shows of it.
struct Step {
  double forward_m = 0.0;
  double turn_m = 0.0;
};

}  // namespace rift::hardware
