#pragma once

#include <limits>

namespace rift::statistics {

/// A number that was not, or could not be, computed looks it.
inline constexpr double kNotComputed = std::numeric_limits<double>::quiet_NaN();

}  // namespace rift::statistics
