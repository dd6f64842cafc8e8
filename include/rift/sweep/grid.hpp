#pragma once

#include <vector>

#include "rift/sweep/result.hpp"

namespace rift::sweep {

/// Full factorial over the levels, the first parameter changing slowest. One empty setting for no
/// parameters. Throws std::invalid_argument for a continuous axis.
std::vector<std::vector<ParameterValue>> GridPoints(const std::vector<Parameter>& parameters);

}  // namespace rift::sweep
