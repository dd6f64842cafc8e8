#pragma once

#include <string_view>

#include "rift/simulation/terrain.hpp"

namespace rift::simulation {

/// Decodes the bytes of a PNG of any colour type, 8 or 16 bits deep, as samples from black 0 to
/// white 1; grey stays as it is, a colour counts by its luminance. Throws std::runtime_error when
/// they are no PNG; the caller knows whose they are.
HeightImage DecodeHeightImage(std::string_view png_bytes);

}  // namespace rift::simulation
