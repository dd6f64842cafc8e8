#pragma once

#include "rift/simulation/mocap.hpp"

namespace rift::simulation {

/// A camera that measures every number exactly, on even frames.
inline MocapOptions Quiet() {
  MocapOptions options;
  options.frame_jitter_s = options.stamp_jitter_s = 0.0;
  options.noise_across_m = options.noise_along_m = options.noise_yaw_rad = 0.0;
  options.blur_across_s = options.blur_yaw_rad_per_mps = 0.0;
  options.noise_z_m = options.noise_tilt_rad = 0.0;
  return options;
}

}  // namespace rift::simulation
