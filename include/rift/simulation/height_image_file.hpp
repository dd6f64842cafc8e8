#pragma once

#include <string>

#include "rift/simulation/terrain.hpp"

namespace rift::simulation {

/// Reads a PNG of any colour type as grey samples, 8 or 16 bits deep, black 0 and white 1, without
/// gamma. Throws std::runtime_error naming the file when it cannot be read.
HeightImage ReadHeightImage(const std::string& path);

}  // namespace rift::simulation
