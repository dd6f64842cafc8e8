#pragma once

#include <vector>

#include "rift/sweep/result.hpp"

namespace rift::sweep {

/// Throws std::invalid_argument for a continuous axis, and for more settings than a grid may have.
void CheckGrid(const std::vector<Parameter>& parameters);

/// Full factorial over the levels, the first parameter changing slowest. One empty setting for no
/// parameters. Throws what CheckGrid does.
std::vector<std::vector<ParameterValue>> GridPoints(const std::vector<Parameter>& parameters);

}  // namespace rift::sweep
