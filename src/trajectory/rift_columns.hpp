#pragma once

#include <array>
#include <string_view>

namespace rift::trajectory {

/// Names of the columns of poses of the rift dialect, in the order of StampedPose.
inline constexpr std::array<std::string_view, 9> kRiftColumns{
    "t_s", "x_m", "y_m", "z_m", "roll_rad", "pitch_rad", "yaw_rad", "target_x_m", "target_y_m"};

}  // namespace rift::trajectory
