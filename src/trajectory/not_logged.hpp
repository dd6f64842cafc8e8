#pragma once

#include <cmath>

namespace rift::trajectory {

/// For formats that have no way to say that a value was not logged.
inline double ZeroIfNotLogged(double value) { return std::isnan(value) ? 0.0 : value; }

}  // namespace rift::trajectory
