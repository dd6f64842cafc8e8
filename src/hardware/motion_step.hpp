#pragma once

namespace rift::hardware {

/// Forward and turning part of a motion, both in metres at a wheel: what the wheels rolled, or what
/// the pose shows of it.
struct Step {
  double forward_m = 0.0;
  double turn_m = 0.0;
};

}  // namespace rift::hardware
