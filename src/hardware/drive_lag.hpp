#pragma once

#include <optional>
#include <span>

#include "rift/hardware/latency.hpp"

namespace rift::hardware {

/// By how much the turns that the camera saw over a whole drive lag those of its wheels. None where
/// it cannot be told: wheels that are not timed (AreTimed), hardly a turn, no clear lag within a
/// second.
std::optional<double> LagOverDrive(std::span<const Angle> seen, std::span<const Angle> wheels);

}  // namespace rift::hardware
