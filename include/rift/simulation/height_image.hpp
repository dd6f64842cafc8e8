#pragma once

#include <string_view>

#include "rift/simulation/terrain.hpp"

namespace rift::simulation {

/// Decodes the bytes of a PNG of any colour type as grey samples, 8 or 16 bits deep, black 0 and
/// white 1, a colour by its luminance and grey untouched. Throws std::runtime_error when they are
/// no PNG; the caller knows whose they are.
HeightImage DecodeHeightImage(std::string_view png_bytes);

}  // namespace rift::simulation
