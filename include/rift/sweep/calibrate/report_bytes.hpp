#pragma once

#include <string>
#include <string_view>

#include "rift/sweep/calibrate/identification.hpp"

namespace rift::sweep {

/// A report as bytes, for another process of the same build. Every number keeps every bit; where a
/// parameter was written (FreeParameter::origin) is left out.
std::string EncodeReport(const CalibrationReport& report);
/// Throws std::runtime_error for bytes of another layout.
CalibrationReport DecodeReport(std::string_view bytes);

}  // namespace rift::sweep
