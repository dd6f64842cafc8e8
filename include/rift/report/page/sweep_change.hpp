#pragma once

#include <string>

#include "rift/sweep/explain/sweep_change.hpp"

namespace rift::report {

/// Two sweeps side by side as one HTML page that needs nothing else, scripts included.
std::string RenderChange(const sweep::SweepChange& change);

}  // namespace rift::report
